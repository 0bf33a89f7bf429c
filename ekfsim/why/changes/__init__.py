"""What can be put right in a run, each alone; no change touches another's draw.

told.py      the told noise, start and sigma made true      maps.py   the told map, wall by wall
faults.py    each fault, slip and kidnap taken out          beams.py  beams left out, or held to
singles.py   single readings left out, moves made exact               what they truly meet
suspects.py  which mechanism each takes away                alike.py  walls in a row
guesses.py   what may be wrong with a log's filter       recorded.py each guess put right
driven.py    all of it of a robot that is driven            groups.py its readings and motions, many
                                                                      at a time
"""
