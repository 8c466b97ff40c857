"""Wang et al. 2023: faults of single satellites in a train's tightly coupled GNSS/INS. One condition in each file."""
