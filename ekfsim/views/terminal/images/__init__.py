"""The real picture in a terminal that draws images: kitty's protocol, iTerm2's, or sixel.

asking.py  what the terminal says it can draw    images.py     the picture of a view in its place
sixel.py   pixels → sixels                       protocols.py  PNG → what kitty and iTerm2 read
"""
