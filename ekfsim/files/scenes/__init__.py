"""World, commands and study files → scenes; all mistakes at once.

checking/   what of them no schema can say
"""
