"""autograder.zip of Gradescope: the homework, this program, and the Python that it needs.

making.py           what goes into it
setup.sh.txt        run once, where the image is made: brings a Python, and what ekfsim needs
run_autograder.txt  run for each submission: leaves results/results.json, whatever happens
"""
