"""Whether to believe a filter, and what should be known of a reading before it is used.

nees.py       normalised estimation error squared, aware of the rank of P
coverage.py   whether the truth is inside the ellipse and the cone
unplaced.py   whether a crowd that began all over the floor tells a place by now
ambiguity.py  whether a beam may meet another wall than the one predicted
innovations.py  the innovations of a run, by sensor and target, in units of their own σ
whiteness.py  whether those of one sensor are white around zero
chances.py    of χ², of Beta variables and of coins
verdict.py    what one run says: ΣNIS against its band, lost or not
shutting_out.py  whether a filter that weighs its readings believes them no more, and since when
summary.py    what is left of one run: errors, NIS, dead reckoning, the verdict
"""
