"""Wrong parts, each wrong in one way that a law forbids: what test_mutations.py shows the laws to catch."""
