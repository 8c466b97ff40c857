# The public names: what `import sensorfault as sf` offers, and where each one lives. The only list of them: type
# checkers read this file, and so does sensorfault/__init__.py when it runs.
from sensorfault.core.monitor import Monitor as Monitor
from sensorfault.core.verdicts import FAULT as FAULT
from sensorfault.core.verdicts import OK as OK
from sensorfault.core.verdicts import UNKNOWN as UNKNOWN
from sensorfault.core.verdicts import VERDICTS as VERDICTS
from sensorfault.evaluation.campaign import campaign as campaign
from sensorfault.evaluation.judge import judge as judge
from sensorfault.events.event import Event as Event
from sensorfault.events.export import write_events as write_events
from sensorfault.faults.fault import Fault as Fault
from sensorfault.faults.inject import inject as inject
from sensorfault.logs import Log as Log
from sensorfault.logs import LogError as LogError
from sensorfault.logs import read as read
from sensorfault.logs import write as write
from sensorfault.methods.catalog import METHODS as METHODS
from sensorfault.methods.fit import fit as fit
from sensorfault.report.page import write_page as write_page
from sensorfault.report.plot import plot as plot
from sensorfault.runtime.detect import Live as Live
from sensorfault.runtime.detect import detect as detect
from sensorfault.runtime.model import Model as Model
from sensorfault.runtime.result import Detection as Detection
from sensorfault.runtime.store import load as load
from sensorfault.runtime.store import save as save
from sensorfault.simulation.road import drive as drive

__version__: str
