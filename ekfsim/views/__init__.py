"""How people see a run: narrative, frames, the terminal, a window. Everything here is a function of Steps."""
