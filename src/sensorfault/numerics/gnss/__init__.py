"""Satellite navigation: where satellites are, what their clocks show, what the air does to a signal.

Every function is pure and takes NumPy arrays as well as JAX's, under jit, vmap and grad: it works in the namespace of
what it is given (the array API standard). Float64 throughout: a float32 holds a pseudorange to two metres.
"""
