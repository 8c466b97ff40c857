"""Min et al. 2021: shorts, jams, abnormal motion, bias and miss of a car's sensors. One experiment a file."""
