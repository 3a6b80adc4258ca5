"""Systems whose motion is known, each with its answers in closed form beside it.

The cases of the verification, tests and benchmarks build them here. No answer comes from the code it is held against.
"""
