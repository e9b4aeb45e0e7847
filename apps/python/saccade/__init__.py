# SPDX-License-Identifier: Apache-2.0
"""Next-best-view planning and TSDF mapping for robot-held depth cameras.

Metres, radians unless a name says _deg; camera frame x right, y down, z forward; poses T_world_camera as 4 x 4 arrays."""
import sys

from ._saccade import *  # noqa: F401,F403
from ._saccade import trial

sys.modules[__name__ + ".trial"] = trial  # for `import saccade.trial`
