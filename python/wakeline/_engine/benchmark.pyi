"""
Steps of one track, for `wakeline bench` to time.
"""

__all__ = ["steps"]

def steps(work: str, *, hand: bool, rounds: int) -> int:
    """
    Goes round a course, each round from the same start, and keeps nothing.

    Parameters
    ----------
    work : str
        kf_step, ekf_polar_step, ukf5_step, imm3_step or imm5_step.
    hand : bool
        True: the loop that one writes by hand from the book, in fixed-size Eigen. False: the engine's
        templates, which check every step and tell more of it.
    rounds : int

    Returns
    -------
    int
        How many steps these were.

    Raises
    ------
    ValueError
        When the work is another.
    """
