"""What Linux is asked for, and Python has no function for; elsewhere there is none."""

import ctypes
import os
from collections.abc import Sequence
from contextlib import suppress

from ekfsim.student.sandbox.limits import LINUX

SET_PDEATHSIG, SET_CHILD_SUBREAPER, SET_NO_NEW_PRIVS = 1, 36, 38  # of prctl(2)
CAPABILITIES = 0x20080522  # the form in which capset(2) is told them: two times three words of 32

# landlock(7): its system calls have these numbers on every machine, its accesses these bits
CREATE_RULESET, ADD_RULE, RESTRICT_SELF = 444, 445, 446
VERSION, PATH_BENEATH = 1, 1
EXECUTE, WRITE_FILE, READ_FILE, READ_DIR, TRUNCATE = (1 << bit for bit in (0, 1, 2, 3, 14))
ACCESSES = (0, 13, 14, 15, 15, 16)  # how many bits each version knows
OF_FILES = EXECUTE | WRITE_FILE | READ_FILE | TRUNCATE | 1 << 15
CLOSED_TCP, CLOSED_SIGNALS = 4, 6  # the versions that first keep from them
READING = EXECUTE | READ_FILE | READ_DIR
SYSTEM = ("/usr", "/lib", "/lib64", "/bin", "/sbin", "/etc/ld.so.cache", "/etc/localtime")
DEVICES = ("/dev/urandom", "/dev/zero", "/proc/cpuinfo", "/proc/meminfo", "/sys/devices/system/cpu")


class Ruleset(ctypes.Structure):
    """What is kept from, but for what a rule allows."""

    _fields_ = (("files", ctypes.c_uint64), ("net", ctypes.c_uint64), ("scoped", ctypes.c_uint64))


class Beneath(ctypes.Structure):
    """What is allowed beneath a place."""

    _pack_ = 1
    _fields_ = (("allowed", ctypes.c_uint64), ("place", ctypes.c_int32))


def prctl(option: int, value: int) -> None:
    """Set one of the properties of this process; see its page in section 2 of the manual."""
    if LINUX:
        ctypes.CDLL(None).prctl(option, value, 0, 0, 0)


def give_up_privileges() -> None:
    """Nothing that is started gains any; the superuser keeps no more than his files."""
    if LINUX:
        prctl(SET_NO_NEW_PRIVS, 1)
        head, none = (ctypes.c_uint32 * 2)(CAPABILITIES, 0), (ctypes.c_uint32 * 6)()
        ctypes.CDLL(None).capset(head, none)


def landlock() -> int:
    """The version of Landlock that this kernel has, 0 where it has none."""
    if not LINUX:
        return 0
    version: int = ctypes.CDLL(None).syscall(CREATE_RULESET, None, ctypes.c_size_t(0), VERSION)
    return max(0, version)


def fence(own: str, read: Sequence[str]) -> int:
    """Let this process and what it starts write below `own` alone, and read there and at `read`.

    The version of Landlock that does it, 0 where there is none: 4 keeps from TCP, too, and 6 from
    sending signals to who is outside. See landlock(7).
    """
    version = landlock()
    if not version:
        return 0
    libc = ctypes.CDLL(None)
    known = (1 << ACCESSES[min(version, len(ACCESSES) - 1)]) - 1
    kept = Ruleset(known, 3 if version >= CLOSED_TCP else 0, 3 if version >= CLOSED_SIGNALS else 0)
    size = ctypes.c_size_t(8 if version < CLOSED_TCP else 16 if version < CLOSED_SIGNALS else 24)
    rules = libc.syscall(CREATE_RULESET, ctypes.byref(kept), size, 0)
    if rules < 0:
        return 0
    allowed = dict.fromkeys((*SYSTEM, *DEVICES, *read), READING)
    for place, access in {**allowed, os.devnull: OF_FILES, own: known}.items():
        with suppress(OSError):
            descriptor = os.open(place, os.O_PATH | os.O_CLOEXEC)
            access &= known if os.path.isdir(place) else known & OF_FILES
            rule = Beneath(access, descriptor)
            libc.syscall(ADD_RULE, rules, PATH_BENEATH, ctypes.byref(rule), 0)
            os.close(descriptor)
    done = libc.syscall(RESTRICT_SELF, rules, 0)
    os.close(rules)
    return version if done == 0 else 0


def lacking(fenced: int, linux: bool = LINUX) -> tuple[str, ...]:
    """What a student's code is not kept from on this machine; see docs/course/safety.md.

    fenced : the version of Landlock that is around it, 0 for none
    """
    told = []
    if not linux:
        told.append("it may take any memory, and outlive its test in a session of its own")
    if not fenced:
        told.append("it can read and write what you can")
    if fenced < CLOSED_TCP:
        told.append("it can open connections to the network")
    if fenced < CLOSED_SIGNALS:
        told.append("it can send signals to your processes")
    return tuple(told)
