"""
Where to look for a target's plot.
"""

from numpy.typing import ArrayLike

__all__ = ["ChiSquareGate", "RadiusGate"]

class ChiSquareGate:
    """
    The ellipsoid that holds the target's own plot with a given probability.
    """
    def __init__(self, *, probability: float = 0.99) -> None: ...
    def threshold(self, dof: int) -> float:
        """
        Largest normalised innovation squared inside, for `dof` measured quantities.
        """
    @property
    def probability(self) -> float: ...

class RadiusGate:
    """
    A circle of fixed radius about the predicted position.
    """
    def __init__(self, *, radius_m: float = 100.0) -> None: ...
    def contains(self, predicted_m: ArrayLike, plot_m: ArrayLike) -> bool:
        """
        Whether a plot [north, east] lies inside.
        """
    @property
    def radius_m(self) -> float: ...
