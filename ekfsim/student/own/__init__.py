"""A filter of one's own: from the place of its code to a filter like any other.

loading.py   FILE.py, FILE.py:Name, package.module:Name → its code, imported at home
home.py      where a student's code is at home: its folder, its modules, its lines
forms.py     two functions, a class with x and P, a class of the full protocol
handed.py    motion and sensor as the code is handed them
returned.py  what comes back: two values, shapes, finite numbers; then whether they can be
calls.py     the calls, in this process
derivatives.py  F, G and H, where a student wrote them, too
filter.py    the filter around them
whole.py     a class of the full protocol, looked after
choice.py    the filter that a place stands for
bring.py     the same of what stands in a cell of a notebook
"""
