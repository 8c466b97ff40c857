"""Wang S. et al.: the height of a flapping-wing aircraft, monitored by an observer over several steps."""
