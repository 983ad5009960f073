"""Errors between pictures, and what noise alone would make them."""

from dataclasses import dataclass

import numpy as np

# Of relMSE: keeps dark pixels from dominating.
FLOOR = 0.01
# Pixels along a side of the blocks in which a bias shows that single pixels hide in noise.
BLOCK = 16


def rel_mse(picture: np.ndarray, reference: np.ndarray) -> float:
    """Mean over pixels and channels of (x - r)² / (r² + 0.01), linear radiance."""
    return float(np.mean((picture - reference) ** 2 / (reference**2 + FLOOR)))


def blocks(pictures: np.ndarray) -> np.ndarray:
    """Means over blocks of pixels; the last three axes are rows, columns, channels."""
    *outer, rows, columns, channels = pictures.shape
    cut = pictures.reshape(*outer, rows // BLOCK, BLOCK, columns // BLOCK, BLOCK, channels)
    return cut.mean(axis=(-4, -2))


@dataclass
class Converged:
    """A picture as the mean of independent batches, (batches, rows, columns, channels)."""

    batches: np.ndarray
    spp: int

    @property
    def mean(self) -> np.ndarray:
        return self.batches.mean(axis=0)

    def variance_of_mean(self) -> np.ndarray:
        return self.batches.var(axis=0, ddof=1) / len(self.batches)

    def in_blocks(self) -> "Converged":
        return Converged(blocks(self.batches), self.spp)

    def level(self) -> tuple[float, float]:
        """Mean radiance and its standard error."""
        levels = self.batches.mean(axis=(1, 2, 3))
        return float(levels.mean()), float(levels.std(ddof=1) / np.sqrt(len(levels)))

    def noise(self) -> float:
        """relMSE of the mean picture against the true one, from its own batches."""
        return float(np.mean(self.variance_of_mean() / (self.mean**2 + FLOOR)))


@dataclass
class Agreement:
    """How far two converged pictures are the same."""

    ratio: float
    ratio_error: float
    pixels: float
    pixels_noise: float
    blocks: float
    blocks_noise: float

    @classmethod
    def between(cls, a: Converged, b: Converged) -> "Agreement":
        (level_a, error_a), (level_b, error_b) = a.level(), b.level()
        ratio = level_a / level_b
        spread = ratio * np.hypot(error_a / level_a, error_b / level_b)
        return cls(ratio, float(spread), *difference(a, b), *difference(a.in_blocks(), b.in_blocks()))


def difference(a: Converged, b: Converged) -> tuple[float, float]:
    """relMSE between the means, and its expectation if both estimate the same picture. r is the mean of both: with one
    of them as r, its own noise would make dark pixels darker and their errors greater than expected."""
    scale = ((a.mean + b.mean) / 2) ** 2 + FLOOR
    noise = (a.variance_of_mean() + b.variance_of_mean()) / scale
    return float(np.mean((a.mean - b.mean) ** 2 / scale)), float(noise.mean())


def combined(a: Converged, b: Converged) -> tuple[np.ndarray, float]:
    """Both means, weighted by the inverse of their noise, and the noise of the result."""
    noise_a, noise_b = a.noise(), b.noise()
    share = noise_b / (noise_a + noise_b)
    return a.mean * share + b.mean * (1.0 - share), noise_a * noise_b / (noise_a + noise_b)


def spread(values: list[float]) -> str:
    """Median, and least to greatest."""
    return f"{np.median(values):.3f} ({min(values):.3f}–{max(values):.3f})"
