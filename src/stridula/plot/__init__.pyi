"""Types of the public names, which `__init__.py` imports on first use."""

from .bands import third_octaves as third_octaves
from .colours import LINE as LINE
from .colours import LINES as LINES
from .colours import STATUS_COLOURS as STATUS_COLOURS
from .directivities import directivity as directivity
from .files import save as save
from .films import animate as animate
from .laws import friction as friction
from .loci import root_loci as root_loci
from .maps import regime_map as regime_map
from .mobilities import mobility as mobility
from .mode_films import animate_mode as animate_mode
from .reels import Film as Film
from .shapes_of_modes import mode_shapes as mode_shapes
from .space_films import bodies as bodies
from .spectra import spectrum as spectrum
from .spectrograms import spectrogram as spectrogram
from .squeals import squeal_map as squeal_map
from .surfaces import animate_surface as animate_surface
from .surfaces import surface as surface
from .systems import system as system
from .timelines import overview as overview
from .timelines import timeline as timeline
from .views import view as view
from .views import view_mode as view_mode
from .waterfalls import waterfall as waterfall
