"""Satellite navigation: satellite positions and clocks, and the delays of a signal in the atmosphere.

Every function is pure and takes NumPy arrays as well as JAX's, under jit, vmap and grad: it works in the namespace of
what it is given (the array API standard). Float64 throughout: a float32 holds a pseudorange to two metres.
"""
