"""Types of the public names, which `__init__.py` imports on first use."""

from .basins import basin as basin
from .branches import follow_cycle as follow_cycle
from .calibration import CalibrationProgress as CalibrationProgress
from .calibration import Target as Target
from .calibration import calibrate as calibrate
from .computed import SweepProgress as SweepProgress
from .ensembles import ensemble as ensemble
from .ensembles import mean_and_interval as mean_and_interval
from .ensembles import share_of as share_of
from .growth_probability import mode_probability as mode_probability
from .loci import critical_value as critical_value
from .loci import root_loci as root_loci
from .mode_derivatives import mode_sensitivity as mode_sensitivity
from .orbit_diagrams import orbit_diagram as orbit_diagram
from .points import Grid as Grid
from .points import LatinHypercube as LatinHypercube
from .points import Range as Range
from .probabilities import regime_probability as regime_probability
from .random_points import RandomPoints as RandomPoints
from .sobol import sensitivity as sensitivity
from .step_checks import StepCheck as StepCheck
from .step_checks import check_step as check_step
from .surveys import squeal_survey as squeal_survey
from .sweeps import sweep as sweep
from .tables import survey_table as survey_table
from .verdicts import agreement as agreement
