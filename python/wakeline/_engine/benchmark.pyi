"""
Steps of one track, for `wakeline bench` to time.
"""

__all__: list = ['steps']
def steps(work: str, *, rounds: int) -> int:
    """
    Goes round a course, each round from the same start, and keeps nothing.
    
    Parameters
    ----------
    work : str
        kf_step, ekf_polar_step, ukf5_step, imm3_step or imm5_step.
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
