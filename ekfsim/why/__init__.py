"""Why a run was lost: one thing put right at a time, and the very same draws played again.

records.py      Change, Tried, Mechanism, Shares, Explanation: what is asked and what was found
replaying.py    a scene with changes → its Steps, and what they say
changes.py      every change of a scene, each alone
explaining.py   explain: the changes tried, the smallest set that cures, and its name
"""

from ekfsim.why.explaining import explain
from ekfsim.why.records import Change, Explanation, Mechanism, Shares, Tried

__all__ = ["Change", "Explanation", "Mechanism", "Shares", "Tried", "explain"]
