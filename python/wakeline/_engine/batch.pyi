"""
Many runs at once: lanes and threads.
"""

__all__: list = ['lanes', 'threads', 'set_threads']
def lanes() -> int:
    """
    Runs side by side in one register of this processor.
    """
def set_threads(threads: int) -> None:
    """
    Set the number of threads that all simultaneous calls share. Results do not depend on it.
    """
def threads() -> int:
    """
    Threads that all simultaneous calls share: the environment's WAKELINE_THREADS or OMP_NUM_THREADS, else the processors that the process may run on, unless set.
    """
