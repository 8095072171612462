"""
Many runs at once: lanes and threads.
"""

__all__ = ["lanes", "set_threads", "threads"]

def lanes() -> int:
    """
    Runs that go side by side in one register of this processor.
    """

def set_threads(threads: int) -> None:
    """
    Sets how many threads all calls at one time use together. Results do not depend on it.
    """

def threads() -> int:
    """
    Threads that all calls at one time use together: the environment's WAKELINE_THREADS or OMP_NUM_THREADS, else the processors that the process may run on, unless set.
    """
