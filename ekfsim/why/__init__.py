"""Why a run was lost: one thing put right at a time, and the very same draws played again.

records.py     Change, Tried, Mechanism, Shares, Explanation: what is asked and what was found
explaining.py  explain: the changes tried, the smallest set that cures, and its name
changes/       what can be put right, each alone; suspects: which mechanism each takes away
trying/        a scene with changes → its Steps; one run within a budget, many runs side by side;
               which suspects it was, by both; the smallest set that cures
"""

from ekfsim.why.explaining import explain
from ekfsim.why.records import Change, Explanation, Mechanism, Shares, Tried

__all__ = ["Change", "Explanation", "Mechanism", "Shares", "Tried", "explain"]
