"""What must obey the laws, beside the recipes: one file a case, or a family of near-equal ones.

A module registers itself by standing here. `CASES` has a function for each name that makes its Case. `HAVE`, where it
is, says which of them have what only some cases have: "permuted", "block", "rate" or "moving". A recipe that the case
of its family does not suit has a module with the name of its own file.
"""
