"""A slow twin of the march, for any bodies, connections, tracks and laws, and several contacts.

Written from the equations of the model in their two-position form, with one matrix for all modes of all bodies::

    q[n+1] = A q[n] - B q[n-1] + L f[n]

for the forces f of drives and contacts, in the numbered steps of *Contact in one step* (`docs/model.rst`). The exact
scheme takes its matrices from the exponential of the state matrix over a step forwards and one backwards. The contacts
are solved together by trying every combination of their states, the velocities of sliding from root finding. It uses no
code of the kernels, and of bodies their modes, traces and numbers only.
"""

from .march import march
from .modes import central, exact

__all__ = ["central", "exact", "march"]
