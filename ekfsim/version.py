"""The version, which every output holds. To ask the installed package for it would take a tenth of
a second.
"""

VERSION = "0.1.0"
