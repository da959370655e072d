"""Other identification packages on the same recordings, in a Python of their own.

`motion` has what all of them read; each rival is one module with a function `predict` that learns from
motions and returns the torques of the held-out one; `__main__` runs one of them; `comparison`, in the
command's own Python, runs all and writes the table.
"""
