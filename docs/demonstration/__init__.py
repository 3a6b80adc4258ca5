"""What the demonstration on the home page plays: runs of two cases over two values, and how they are written.

``python -m demonstration`` in ``docs`` computes all of them anew, in some ten minutes.
"""
