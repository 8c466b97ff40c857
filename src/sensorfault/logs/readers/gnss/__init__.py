"""Raw satellite navigation: pseudoranges, and where the satellites were."""
