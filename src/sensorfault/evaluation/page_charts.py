"""The plots of the report page, as plain Plotly figures: data and layout, to be written as JSON.

All share one time axis. A colour is the name of a CSS variable, so that the page's style sheet alone knows colours, and
an array travels as `{"f8": base64}`; page.js puts in both.
"""

from base64 import b64encode
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from typing import Any

import numpy as np

from sensorfault.detection import Detection, Trace
from sensorfault.evaluation.page_lines import Span, line, near, runs
from sensorfault.evaluation.page_words import clock, found, number
from sensorfault.events import Event
from sensorfault.faults.fault import Fault
from sensorfault.logs.table import Channel, Sensor
from sensorfault.logs.units import from_si
from sensorfault.types import FAULT, OK, UNKNOWN, VERDICTS

Json = dict[str, Any]
