"""Wang S. et al.: the height of a flapping-wing aircraft, watched by an observer that looks several steps ahead."""
