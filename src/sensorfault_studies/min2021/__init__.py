"""Min et al. 2021: spike, frozen, offset and missing faults of a car's sensors (short, jam, bias and miss in the
paper), and abnormal motion.
"""
