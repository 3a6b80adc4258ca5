"""Types of the public names, which `__init__.py` imports on first use."""

from .air import Air as Air
from .bridges import Bridge as Bridge
from .levels import equivalent_level as equivalent_level
from .levels import harmonic_levels as harmonic_levels
from .levels import sound_level as sound_level
from .levels import third_octave_levels as third_octave_levels
from .listening import PlayableSound as PlayableSound
from .listening import listen as listen
from .radiate import radiate as radiate
from .resistance import radiation_damping as radiation_damping
from .resistance import radiation_efficiency as radiation_efficiency
from .sensation import loudness as loudness
from .sensation import loudness_over_time as loudness_over_time
from .sensation import prominent_tones as prominent_tones
from .sensation import roughness as roughness
from .sensation import sharpness as sharpness
from .squeals import squeal_events as squeal_events
from .wav import SoundFile as SoundFile
from .wav import read_wav as read_wav
from .wav import write_wav as write_wav
