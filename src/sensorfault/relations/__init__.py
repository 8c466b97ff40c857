"""The default method: what one sensor says, checked against what the others say. No JAX here."""
