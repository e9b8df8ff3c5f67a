#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Posterior of propulsion and random force of the paper's field, from its Table IV: posterior.py GATEWALK SCENE OUT

The data are eight numbers: corrcoef and RMSE of 100 trials, from each of four starts, as atanh and logarithm. Their
distribution at a scene is taken for normal (synthetic likelihood, Wood 2010, doi 10.1038/nature09319): `gatewalk validate` gives
mean and covariance of repeats of 100 trials against one matrix of 100 runs per row, at Sobol points of the ranges; polynomials in
both forces pass between these. What is left of them beyond the repeats' own chance is what matrices differ by, of which the paper
had one. Prior: uniform over the ranges. A second round of points lies where the first put 99.9 %.
Takes OUT/points.csv, or writes it where there is none; writes OUT/posterior.csv, prints intervals, the check of Table IV and
that of the method: of made-up experiments at the points how many intervals hold their forces. p is the share of these that
are as far from what is expected as Table IV is, for surfaces of other degrees too. Walks have the correlations of the exact chain.
"""
import csv
import itertools
import json
import os
import subprocess
import sys
import tempfile

import numpy as np
from scipy.stats import kstest, qmc

gatewalk, scene, out = sys.argv[1:4]
KEYS = ("forces.propulsion_N", "forces.random_N")
LOW, HIGH = np.array([5.0, 10.0]), np.array([9.5, 100.0])
POINTS, BLOCKS, CELLS = 128, 15, 181
COLUMNS = ("round", *KEYS, "d_m", "paper_corrcoef", "paper_rmse", "corrcoef", "corrcoef_sd", "rmse", "rmse_sd", "correlation",
           "walks_corrcoef", "walks_corrcoef_sd", "walks_rmse", "walks_rmse_sd", "outside_bins", "through_RT_LT")


def validated(number: int, theta: np.ndarray, which: int) -> list[dict]:
    """A scene: a line for each start of the paper."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "v.json")
        subprocess.run([gatewalk, "validate", scene, "--trials", str(100 * BLOCKS), "--matrix-trials", "100", "--bins", "paper",
                        "--seed", str(number), "--null-draws", "1", "--quiet",
                        *(f"--set={key}={value!r}" for key, value in zip(KEYS, theta.tolist())), "--json", path],
                       check=True, stdout=subprocess.DEVNULL)
        found = json.load(open(path))
    rows = []
    for start in found["starts"]:
        at = start["at_100_trials"]
        pair = lambda kind: [at[f"{kind}_{name}"][of] for name in ("corrcoef", "rmse_per_100") for of in ("mean", "sd")]  # noqa: E731
        rows.append(dict(zip(COLUMNS, [which, *theta.tolist(), start["start"]["d_m"], start["paper"]["corrcoef"],
                                       start["paper"]["rmse_per_100"], *pair("exact"), at["exact_corrcoef_rmse_correlation"],
                                       *pair("walks"), *(found["crossings"][of] for of in ("clamped_share", "RT_and_LT_share"))])))
    return rows


class Surfaces:
    """Mean and covariance of the eight numbers over the forces, from points in a box."""

    def __init__(self, rows: list[dict], low: np.ndarray, high: np.ndarray, kind: str = "", degree: int = 0):
        scenes = [list(group) for _, group in itertools.groupby(rows, key=lambda row: (row["round"], row[KEYS[0]], row[KEYS[1]]))]
        theta = np.array([[group[0][key] for key in KEYS] for group in scenes])
        inside = ((theta >= low) & (theta <= high)).all(axis=1)
        scenes, self.theta, self.low, self.high = list(itertools.compress(scenes, inside)), theta[inside], low, high
        of = lambda name: np.array([[row[name] for row in group] for group in scenes])  # noqa: E731
        corr, rmse = of(kind + "corrcoef"), of(kind + "rmse")
        # Delta method: means and deviations of atanh and of the logarithm.
        self.means = np.hstack([np.arctanh(corr) + corr * (of(kind + "corrcoef_sd") / (1 - corr**2))**2,
                                np.log(rmse) - (of(kind + "rmse_sd") / rmse)**2 / 2])
        deviations = np.hstack([of(kind + "corrcoef_sd") / (1 - corr**2), of(kind + "rmse_sd") / rmse])
        self.within = [self.covariance(d, r) for d, r in zip(deviations, of("correlation"))]
        self.degree, self.coefficients, left, self.inverse = self.fitted(self.means, degree)
        self.log_deviation = self.fitted(np.log(deviations), 2)[1]
        self.correlation = self.fitted(np.arctanh(of("correlation")), 2)[1]
        # Between matrices: what the surfaces leave, without the repeats' own share; no direction below nothing.
        self.left = left.T @ left / (len(left) - self.inverse.shape[0])
        values, vectors = np.linalg.eigh(self.left - np.mean(self.within, axis=0) / BLOCKS)
        self.between = vectors * np.maximum(values, 0) @ vectors.T

    @staticmethod
    def covariance(deviations: np.ndarray, correlation: np.ndarray) -> np.ndarray:
        matrix = np.diag(deviations**2)
        for start, r in enumerate(correlation):
            matrix[start, start + 4] = matrix[start + 4, start] = r * deviations[start] * deviations[start + 4]
        return matrix

    def basis(self, theta: np.ndarray, degree: int) -> np.ndarray:
        x, y = ((2 * theta - self.low - self.high) / (self.high - self.low)).T
        return np.stack([x**i * y**j for i in range(degree + 1) for j in range(degree + 1 - i)], axis=1)

    def fitted(self, values: np.ndarray, degree: int = 0):
        """Degree (of least leave-one-out error where none is given), coefficients, residuals, inverse of the normal matrix."""
        best = None
        for d in [degree] if degree else range(1, 6):
            basis = self.basis(self.theta, d)
            if 2 * basis.shape[1] > len(basis):
                break
            inverse = np.linalg.inv(basis.T @ basis)
            coefficients = inverse @ basis.T @ values
            left = values - basis @ coefficients
            missed = left / (1 - np.einsum("ij,jk,ik->i", basis, inverse, basis))[:, None]
            error = np.log((missed**2).mean(axis=0)).sum()
            if best is None or error < best[0]:
                best = error, d, coefficients, left, inverse
        return best[1:]

    def normal(self, theta: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Mean (n x 8) and covariance (n x 8 x 8) of an experiment, its own matrix and the surfaces' error in it."""
        basis, second = self.basis(theta, self.degree), self.basis(theta, 2)
        spread = np.einsum("ij,jk,ik->i", basis, self.inverse, basis)
        within = [self.covariance(d, r) for d, r in zip(np.exp(second @ self.log_deviation), np.tanh(second @ self.correlation))]
        return basis @ self.coefficients, np.array(within) + self.between + spread[:, None, None] * self.left


class Posterior:
    """On a grid of the box."""

    def __init__(self, surfaces: Surfaces):
        self.axes = [np.linspace(low, high, CELLS) for low, high in zip(surfaces.low, surfaces.high)]
        self.grid = np.stack(np.meshgrid(*self.axes, indexing="ij"), axis=-1).reshape(-1, 2)
        self.mean, covariance = surfaces.normal(self.grid)
        self.inverse, self.log_det = np.linalg.inv(covariance), np.linalg.slogdet(covariance)[1]

    def of(self, data: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Weights and squared distances of the grid."""
        off = data - self.mean
        misfit = np.einsum("ij,ijk,ik->i", off, self.inverse, off)
        logs = -(misfit + self.log_det) / 2
        weights = np.exp(logs - logs.max())
        return weights / weights.sum(), misfit

    def marginal(self, weights: np.ndarray, axis: int) -> np.ndarray:
        return weights.reshape(CELLS, CELLS).sum(axis=1 - axis)

    def quantile(self, weights: np.ndarray, axis: int, share: float) -> float:
        return float(np.interp(share, np.cumsum(self.marginal(weights, axis)), self.axes[axis]))


def region(posterior: Posterior, weights: np.ndarray, share: float) -> tuple[np.ndarray, np.ndarray]:
    order = np.argsort(-weights)
    kept = posterior.grid[order[: np.searchsorted(np.cumsum(weights[order]), share) + 1]]
    return kept.min(axis=0), kept.max(axis=0)


def made_up(surfaces: Surfaces) -> np.ndarray:
    """Experiments at the scenes themselves: their own mean, so a matrix of their own, and the chance of 100 trials."""
    chance = np.random.default_rng(1)
    return np.array([chance.multivariate_normal(mean, within) for mean, within in zip(surfaces.means, surfaces.within)])


def further_off(surfaces: Surfaces, posterior: Posterior, data: np.ndarray) -> tuple[float, float]:
    """Mean misfit of the data, and the share of made-up experiments with as large a one."""
    def misfit_of(experiment: np.ndarray) -> float:
        weights, misfit = posterior.of(experiment)
        return float(weights @ misfit)
    misfit = misfit_of(data)
    others = [misfit_of(experiment) for experiment in made_up(surfaces)]
    return misfit, (1 + sum(other >= misfit for other in others)) / (1 + len(others))


def answer(surfaces: Surfaces, data: np.ndarray) -> tuple[Posterior, np.ndarray]:
    posterior = Posterior(surfaces)
    weights, _ = posterior.of(data)
    means = weights @ posterior.grid
    spread = np.sqrt(weights @ (posterior.grid - means)**2)
    together = weights @ (posterior.grid - means).prod(axis=1) / spread.prod()
    for axis, key in enumerate(KEYS):
        low, middle, high = (posterior.quantile(weights, axis, share) for share in (0.025, 0.5, 0.975))
        edges = cut_off(posterior, weights, axis)
        print(f"  {key}: {middle:.2f} N, 95 % {low:.2f} to {high:.2f}{edges}")
    print(f"  correlation {together:.2f}; most likely {', '.join(f'{v:.2f} N' for v in posterior.grid[weights.argmax()])}")
    misfit, p = further_off(surfaces, posterior, data)
    print(f"  check of Table IV: p {p:.3f} (misfit {misfit:.1f}); surfaces of degree {surfaces.degree}, {len(surfaces.theta)} scenes")
    return posterior, weights


def cut_off(posterior: Posterior, weights: np.ndarray, axis: int) -> str:
    """Whether the range cuts the posterior off: an end with over a tenth of the highest density."""
    along = posterior.marginal(weights, axis)
    ends = [name for name, at, limit in (("below", 0, LOW[axis]), ("above", -1, HIGH[axis]))
            if along[at] > along.max() / 10 and abs(posterior.axes[axis][at] - limit) < 1e-9]
    return f" (the range ends there: it may lie {' or '.join(ends)})" if ends else ""


def check(surfaces: Surfaces, posterior: Posterior) -> None:
    held, ranks = np.zeros(2), [[], []]
    for theta, experiment in zip(surfaces.theta, made_up(surfaces)):
        weights, _ = posterior.of(experiment)
        for axis in (0, 1):
            along = posterior.marginal(weights, axis)
            rank = float(np.interp(theta[axis], posterior.axes[axis], np.cumsum(along) - along / 2))
            ranks[axis].append(rank)
            held[axis] += 0.025 <= rank <= 0.975
    for axis, key in enumerate(KEYS):
        print(f"  {key}: 95 % intervals hold {100 * held[axis] / len(surfaces.theta):.0f} % of {len(surfaces.theta)} made-up experiments; "
              f"ranks uniform, p {kstest(ranks[axis], 'uniform').pvalue:.2f}")


def main() -> None:
    path = os.path.join(out, "points.csv")
    kept: list[dict] = []
    program = subprocess.run([gatewalk, "--version"], check=True, capture_output=True, text=True).stdout.split("\n")[0]
    if os.path.exists(path):
        with open(path) as file:
            program = file.readline().removeprefix("# ").strip()
            kept = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]
        if [sum(row["round"] == which for row in kept) for which in (1, 2)] != [4 * POINTS] * 2:
            sys.exit(f"{path}: does not have both rounds of {POINTS} scenes; remove it to run them")
    rows: list[dict] = []
    low, high = LOW, HIGH
    walks_box = LOW, HIGH
    for which in (1, 2):
        rows += [row for row in kept if row["round"] == which]
        if not kept:
            for number, unit in enumerate(qmc.Sobol(2, seed=which).random(POINTS)):
                rows += validated(1000 * which + number, low + (high - low) * unit, which)
        data = np.concatenate([np.arctanh([row["paper_corrcoef"] for row in rows[:4]]), np.log([row["paper_rmse"] for row in rows[:4]])])
        if which == 1:
            first = Posterior(Surfaces(rows, LOW, HIGH))
            low, high = region(first, first.of(data)[0], 0.999)
            walks = Posterior(Surfaces(rows, LOW, HIGH, "walks_"))
            walks_box = region(walks, walks.of(data)[0], 0.999)
    if not kept:
        with open(path, "w", newline="") as file:
            file.write(f"# {program}\n")
            writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
            writer.writeheader()
            writer.writerows({key: f"{value:.6g}" for key, value in row.items()} for row in rows)
    print(f"points.csv: {program}")
    print(f"F_prop {low[0]:.2f} to {high[0]:.2f} N, Rm {low[1]:.1f} to {high[1]:.1f} N hold 99.9 % after the first {POINTS} scenes. "
          "Exact chain against 100 trials:")
    surfaces = Surfaces(rows, low, high)
    posterior, weights = answer(surfaces, data)
    for degree in (2, 4, 5):
        other = Surfaces(rows, low, high, degree=degree)
        at = Posterior(other)
        misfit, p = further_off(other, at, data)
        print(f"  degree {degree}: F_prop {at.quantile(at.of(data)[0], 0, 0.5):.2f} N, p {p:.3f} (misfit {misfit:.1f})")
    check(surfaces, posterior)
    print(f"100 walks of the chain in its place, F_prop {walks_box[0][0]:.2f} to {walks_box[1][0]:.2f} N, "
          f"Rm {walks_box[0][1]:.1f} to {walks_box[1][1]:.1f} N:")
    answer(Surfaces(rows, *walks_box, "walks_"), data)
    order = np.argsort(-weights)
    beyond = np.empty_like(weights)
    beyond[order] = np.cumsum(weights[order])
    with open(os.path.join(out, "posterior.csv"), "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["propulsion_N", "random_N", "density_over_highest", "share_denser"])
        drawn = np.arange(CELLS**2).reshape(CELLS, CELLS)[::3, ::3].ravel()
        for theta, weight, share in zip(posterior.grid[drawn], weights[drawn] / weights.max(), beyond[drawn]):
            writer.writerow([f"{theta[0]:.4g}", f"{theta[1]:.4g}", f"{weight:.4g}", f"{share:.4g}"])


main()
