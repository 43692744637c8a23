"""Statistics used by the checks."""

import functools
import math

import numpy as np


def mean_and_error(values):
    values = np.asarray(values, float)
    return float(values.mean()), float(values.std(ddof=1) / math.sqrt(len(values)))


def chi_square_p(x, freedom):
    """P(chi-square > x) for an even number of degrees of freedom, as a finite sum."""
    term = total = math.exp(-x / 2)
    for k in range(1, freedom // 2):
        term *= x / 2 / k
        total += term
    return total


def t_two_sided(t, freedom):
    """P(|T| > |t|) for Student's t. With T = sqrt(freedom) tan a, the density is proportional to cos(a)^(freedom - 1)."""

    def area(low):
        a = np.linspace(low, math.pi / 2, 10_001)
        y = np.cos(a) ** (freedom - 1)
        return float(((y[1:] + y[:-1]) / 2 * np.diff(a)).sum())

    return area(math.atan(abs(t) / math.sqrt(freedom))) / area(0)


@functools.cache
def t_quantile_95(freedom):
    """Two-sided 95 % quantile of Student's t."""
    low, high = 1.0, 1000.0
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if t_two_sided(middle, freedom) > 0.05 else (low, middle)
    return high


def mean_ci95(values):
    mean, error = mean_and_error(values)
    reach = t_quantile_95(len(values) - 1) * error
    return mean, mean - reach, mean + reach


def welch(mean1, sd1, n1, mean2, sd2, n2):
    """Two-sided p-value of Welch's test."""
    a, b = sd1**2 / n1, sd2**2 / n2
    return t_two_sided((mean1 - mean2) / math.sqrt(a + b), (a + b) ** 2 / (a**2 / (n1 - 1) + b**2 / (n2 - 1)))


def line(x, y):
    """Slope and intercept of the least-squares line, and their standard errors."""
    x, y = np.asarray(x, float), np.asarray(y, float)
    sxx = ((x - x.mean()) ** 2).sum()
    slope = ((x - x.mean()) * (y - y.mean())).sum() / sxx
    intercept = y.mean() - slope * x.mean()
    s = math.sqrt(((y - slope * x - intercept) ** 2).sum() / (len(x) - 2))
    return float(slope), float(intercept), s / math.sqrt(sxx), s * math.sqrt(1 / len(x) + x.mean() ** 2 / sxx)


def zero_crossing(x, y):
    """Zero of the least-squares line and its 95 % interval by Fieller; None if the slope does not differ significantly from zero."""
    slope, intercept, se_slope, se_intercept = line(x, y)
    zero, t = -intercept / slope, t_quantile_95(len(x) - 2)
    a = slope**2 - (t * se_slope) ** 2
    if a <= 0:
        return zero, None
    b = slope * intercept + t**2 * np.mean(x) * se_slope**2
    c = intercept**2 - (t * se_intercept) ** 2
    root = math.sqrt(max(0.0, b * b - a * c))
    return zero, (float((-b - root) / a), float((-b + root) / a))


def rank_correlation(x, y):
    """Spearman's rank correlation of values without ties."""
    return float(np.corrcoef(np.argsort(np.argsort(x)), np.argsort(np.argsort(y)))[0, 1])
