# SPDX-License-Identifier: MIT
"""Every statistic of made data against another hand's: scipy, numpy, or the definition written out here.

print_statistics answers with what the program's own functions give. Without scipy this test fails, as it would say nothing.
"""

import json
import math
import os
import subprocess
import unittest

import numpy
from scipy import optimize, special, stats

PROGRAM = os.environ["PRINT_STATISTICS_PROGRAM"]
SEED = 20260101

# Sums of some thousand numbers of one size keep about thirteen digits; a zero of two hands differs by as much of what was summed.
ROUNDING = 1e-12
# A tail of a distribution: the continued fraction's own limit for up to 1e5 degrees of freedom (base/statistics/distributions.h).
# That of scipy has the same size there.
TAIL = 1e-9


def plain(value):
    """As JSON knows it: null for no number."""
    if isinstance(value, numpy.ndarray):
        return plain(value.tolist())
    if isinstance(value, (list, tuple)):
        return [plain(one) for one in value]
    if isinstance(value, dict):
        return {key: plain(one) for key, one in value.items()}
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value


def ask(calls):
    """The answers to calls: (name, arguments)."""
    text = json.dumps([{"call": name, **plain(arguments)} for name, arguments in calls])
    done = subprocess.run([PROGRAM], input=text, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise AssertionError(done.stderr)
    return json.loads(done.stdout)


def ask_one(name, **arguments):
    return ask([(name, arguments)])[0]


class Case(unittest.TestCase):
    def setUp(self):
        self.random = numpy.random.default_rng(SEED)

    def near(self, ours, theirs, relative=ROUNDING, absolute=0.0, what=""):
        """None is theirs' NaN."""
        if theirs is None or not math.isfinite(theirs):
            self.assertIsNone(ours, what)
            return
        self.assertIsNotNone(ours, what)
        self.assertLessEqual(abs(ours - theirs), absolute + relative * abs(theirs), f"{what}: {ours} {theirs}")


class Moments(Case):
    def test_mean_and_deviation(self):
        for size in (1, 2, 3, 1000):
            for offset in (0, 1e6):
                values = offset + self.random.normal(3, 2, size)
                ours = ask_one("moments", values=values)
                self.near(ours["mean"], float(values.mean()))
                # squares of differences: the offset takes six of sixteen digits from each
                self.near(ours["deviation"], float(values.std(ddof=1)) if size > 1 else None, relative=1e-9 if offset else ROUNDING)

    def test_what_does_not_vary(self):
        none, one, same = ask([("moments", {"values": values}) for values in ([], [4.0], [0.1] * 3)])
        self.assertIsNone(none["mean"])
        self.assertIsNone(one["deviation"])
        self.assertFalse(same["varies"])
        self.near(same["deviation"], 0.0, absolute=ROUNDING)

    def test_percentiles(self):
        shares = [0, 0.025, 0.25, 1 / 3, 0.5, 0.975, 1]
        for size in (1, 2, 3, 40, 1001):
            values = self.random.normal(0, 1, size)
            ours = ask_one("percentiles", ascending=numpy.sort(values), shares=shares)
            for share, value in zip(shares, ours):
                self.near(value, float(numpy.percentile(values, 100 * share)), absolute=ROUNDING)
            interval = ask_one("percentile_interval", values=values)
            for value, share in zip(interval, (0.025, 0.975)):
                self.near(value, float(numpy.percentile(values, 100 * share)), absolute=ROUNDING)
        self.assertEqual(ask_one("percentile_interval", values=[]), [None, None])

    def test_boxes(self):
        for size in (1, 4, 5, 200):
            values = self.random.standard_t(2, size)
            ours = ask_one("box", values=values)
            low, middle, high = numpy.percentile(values, [25, 50, 75])
            reach = 1.5 * (high - low)
            within = values[(values >= low - reach) & (values <= high + reach)]
            theirs = [min(within.min(), low), low, middle, high, max(within.max(), high)]
            for value, expected in zip(ours["numbers"], theirs):
                self.near(value, float(expected), absolute=ROUNDING)
            self.assertEqual(ours["outliers"], sorted(values[(values < low - reach) | (values > high + reach)].tolist()))


class Correlations(Case):
    def check(self, ours, theirs, interval):
        self.near(ours["r"], theirs.statistic, absolute=ROUNDING)
        self.near(ours["p"], theirs.pvalue, relative=TAIL)
        # tanh and atanh of r, which is known to ROUNDING
        for value, expected in zip(ours["interval"], interval):
            self.near(value, expected, absolute=10 * ROUNDING)

    def test_pearson(self):
        for size in (4, 5, 30, 4000):
            for slope in (-1, 0, 0.02):
                x = self.random.normal(5, 1, size)
                y = slope * x + self.random.normal(0, 1, size)
                theirs = stats.pearsonr(x, y)
                ours = ask_one("pearson", x=x, y=y)
                for way in ("whole", "running"):
                    self.check(ours[way], theirs, theirs.confidence_interval(0.95))
                self.near(ours["mean_y"], float(y.mean()), absolute=ROUNDING)

    def test_pearson_far_from_nothing(self):
        # 1e6 takes six of sixteen digits from every difference
        x = 1e6 + self.random.normal(0, 1, 500)
        y = 1e6 + self.random.normal(0, 1, 500) - (x - 1e6)
        theirs = stats.pearsonr(x - 1e6, y - 1e6)[0]
        for way in ask_one("pearson", x=x, y=y).values():
            if isinstance(way, dict):
                self.near(way["r"], theirs, absolute=1e-9)

    def test_point_biserial(self):
        for size in (5, 30, 4000):
            for share in (0.3, 0.5):
                yes = self.random.random(size) < share
                yes[:2] = [True, False]
                x = self.random.normal(0, 1, size) + 0.3 * yes
                r, p = stats.pointbiserialr(yes, x)
                ours = ask_one("point_biserial", x=x, yes=yes)
                for way in ("whole", "running"):
                    self.near(ours[way]["r"], r, absolute=ROUNDING)
                    self.near(ours[way]["p"], p, relative=TAIL)

    def test_what_is_lacking(self):
        for x, y, lack in (([1, 2], [3, 4], "fewer_than_3"), ([0.1] * 4, [1, 2, 3, 4], "one_x"), ([1, 2, 3, 4], [7] * 4, "one_y")):
            ours = ask_one("pearson", x=x, y=y)
            for way in ("whole", "running"):
                self.assertEqual(ours[way], {"lack": lack})
        for x, yes, lack in (([1, 2], [True, False], "fewer_than_3"), ([1, 2, 3], [False] * 3, "never"),
                             ([1, 2, 3], [True] * 3, "always"), ([2, 2, 2], [True, False, True], "one_x")):
            ours = ask_one("point_biserial", x=x, yes=yes)
            for way in ("whole", "running"):
                self.assertEqual(ours[way], {"lack": lack})

    def test_a_line_is_certain(self):
        x = numpy.arange(10.0)
        for slope in (3, -3):
            ours = ask_one("pearson", x=x, y=slope * x)
            for way in ("whole", "running"):
                self.near(ours[way]["r"], math.copysign(1, slope))
                # the root of what 1 - r^2 has in rounding, times the degrees of freedom
                self.assertLess(ours[way]["p"], 1e-20)

    def test_p_and_interval_over_a_grid(self):
        grid = [(r, pairs) for r in (-0.999, -0.5, -1e-6, 0, 0.1, 0.9, 0.99) for pairs in (3, 4, 5, 18, 100, 10_000)]
        for (r, pairs), ours in zip(grid, ask([("correlation", {"r": r, "pairs": pairs}) for r, pairs in grid])):
            with self.subTest(r=r, pairs=pairs):
                if abs(r) < 1e-3 or pairs < 1000:  # else the tail is below the smallest number, or near it
                    t = abs(r) * math.sqrt((pairs - 2) / (1 - r * r))
                    self.near(ours["p"], 2 * stats.t.sf(t, pairs - 2), relative=TAIL)
                if pairs == 3:
                    self.assertEqual(ours["interval"], [None, None])
                    continue
                half = stats.norm.ppf(0.975) / math.sqrt(pairs - 3)
                for value, sign in zip(ours["interval"], (-1, 1)):
                    self.near(value, math.tanh(math.atanh(r) + sign * half), absolute=ROUNDING)
        few = ask_one("correlation", r=0.5, pairs=2)
        self.assertIsNone(few["p"])


class Tails(Case):
    def test_incomplete_beta_over_a_grid(self):
        sizes = (0.5, 1, 2.5, 10, 85, 100, 1e3, 1e4, 1e5)
        grid = []
        for a in sizes:
            for b in sizes:
                middle, spread = a / (a + b), math.sqrt(a * b / (a + b + 1)) / (a + b)
                places = {middle + k * spread for k in (-3, -1, -0.1, 0, 0.1, 1, 3)} | {1e-3, 0.5, 0.999}
                grid += [(a, b, x) for x in places if 0 < x < 1]
        for (a, b, x), ours in zip(grid, ask([("incomplete_beta", {"a": a, "b": b, "x": x}) for a, b, x in grid])):
            theirs = float(special.betainc(a, b, x))
            if theirs < 1e-290:  # no more digits in numbers as small
                self.assertLess(ours, 1e-280)
                continue
            # the header's own promise
            self.near(ours, theirs, relative=1e-12 if max(a, b) <= 100 else TAIL, what=f"I_{x}({a}, {b})")
        self.assertGreater(len(grid), 500)

    def test_ends_of_the_incomplete_beta(self):
        ours = ask([("incomplete_beta", {"a": 2, "b": 3, "x": x}) for x in (0, 1)])
        self.assertEqual(ours, [0, 1])

    def test_f_tail_over_a_grid(self):
        grid = [(f, above, below) for f in (1e-3, 0.5, 1, 2, 5, 30) for above in (1, 2, 7, 40) for below in (1, 3, 16, 200, 5000)]
        for (f, above, below), ours in zip(grid, ask([("f_tail", {"f": f, "above": a, "below": b}) for f, a, b in grid])):
            theirs = float(stats.f.sf(f, above, below))
            if theirs > 1e-290:  # no more digits in numbers as small
                self.near(ours, theirs, relative=TAIL, what=f"F({above}, {below}) > {f}")
        self.assertEqual(ask_one("f_tail", f=0, above=2, below=3), 1)


class Shares(Case):
    def test_wilson_is_where_the_score_is_at_its_limit(self):
        z = stats.norm.ppf(0.975)
        for of in (1, 2, 17, 1000):
            for yes in {0, 1, of // 3, of - 1, of}:
                ours = ask_one("share", yes=yes, of=of)
                share = yes / of
                self.near(ours["share"], share)

                def score(p):
                    return (share - p) ** 2 - z * z * p * (1 - p) / of

                # it is below 0 at the share, and above at 0 and 1. A share of 0 or 1 is a root itself, and the end there
                low = optimize.brentq(score, 0, min(share, 1 - 1e-9), xtol=1e-15) if yes else 0
                high = optimize.brentq(score, max(share, 1e-9), 1, xtol=1e-15) if yes < of else 1
                self.near(ours["interval"][0], low, absolute=ROUNDING, what=f"{yes} of {of}")
                self.near(ours["interval"][1], high, absolute=ROUNDING, what=f"{yes} of {of}")

    def test_of_none(self):
        self.assertEqual(ask_one("share", yes=0, of=0), {"share": None, "interval": [None, None]})


class Variance(Case):
    def test_groups(self):
        for sizes in ((5, 5), (3, 4, 5), (1, 30, 200), (2, 0, 3, 0)):
            for apart in (0, 0.5):
                groups = [self.random.normal(apart * k, 1, size) for k, size in enumerate(sizes)]
                ours = ask_one("anova", groups=[group.tolist() for group in groups])
                there = [group for group in groups if len(group)]
                theirs = stats.f_oneway(*there)
                self.near(ours["f"], theirs.statistic, relative=1e-11)  # ratio of two sums of squares
                self.near(ours["p"], theirs.pvalue, relative=TAIL)
                self.assertEqual([ours["between"], ours["within"]], [len(there) - 1, sum(map(len, there)) - len(there)])
                everything = numpy.concatenate(there)
                between = sum(len(group) * (group.mean() - everything.mean()) ** 2 for group in there)
                self.near(ours["share"], between / ((everything - everything.mean()) ** 2).sum(), relative=1e-11)

    def test_what_has_no_analysis(self):
        for groups in ([], [[1, 2, 3]], [[1], [2], [3]], [[], [1, 2]], [[0.1] * 3, [0.2] * 3]):
            self.assertIsNone(ask_one("anova", groups=groups), groups)


class Logistic(Case):
    def fit(self, terms, success, ridge):
        """The largest likelihood by Newton's steps within a trust region, and errors by the curvature there."""
        terms = numpy.column_stack([terms, numpy.ones(len(terms))])
        penalty = numpy.append(ridge * terms[:, :-1].var(axis=0), 0)

        def cost(beta):
            at = terms @ beta
            return numpy.logaddexp(0, at).sum() - at[success].sum() + 0.5 * (penalty * beta * beta).sum()

        def slope(beta):
            return terms.T @ (special.expit(terms @ beta) - success) + penalty * beta

        def curvature(beta):
            p = special.expit(terms @ beta)
            return (terms * (p * (1 - p))[:, None]).T @ terms + numpy.diag(penalty)

        found = optimize.minimize(cost, numpy.zeros(terms.shape[1]), jac=slope, hess=curvature, method="trust-exact",
                                  options={"gtol": 1e-9})
        beta = found.x
        for _ in range(3):  # where the cost's own rounding ends the search
            beta = beta - numpy.linalg.solve(curvature(beta), slope(beta))
        return beta, numpy.sqrt(numpy.diag(numpy.linalg.inv(curvature(beta))))

    def made(self, size, separated=False):
        terms = numpy.column_stack([self.random.normal(2, 3, size), self.random.uniform(-1e-3, 1e-3, size)])
        odds = 0.4 * (terms[:, 0] - 2) - 900 * terms[:, 1] - 0.5
        return terms, odds > 0 if separated else self.random.random(size) < special.expit(odds)

    def test_coefficients_and_errors(self):
        for size in (40, 2000):
            terms, success = self.made(size)
            beta, errors = self.fit(terms, success, 0)
            ours = ask_one("logistic", terms=terms.ravel(), count=2, success=success)
            self.assertTrue(ours["is_fitted"])
            self.assertFalse(ours["has_ridge"])
            # our steps end at 1e-9 of a deviation, and the next one would be its square; a system of three unknowns adds rounding
            for k in range(2):
                self.near(ours["coefficients"][k], beta[k], relative=1e-9)
                self.near(ours["errors"][k], errors[k], relative=1e-9)
                for value, sign in zip(ours["intervals"][k], (-1, 1)):
                    self.near(value, beta[k] + sign * stats.norm.ppf(0.975) * errors[k], absolute=1e-8 * errors[k])
            self.near(ours["intercept"], beta[2], relative=1e-9)

    def test_where_successes_can_be_separated_there_is_a_ridge(self):
        terms, success = self.made(60, separated=True)
        beta, _ = self.fit(terms, success, 1)
        ours = ask_one("logistic", terms=terms.ravel(), count=2, success=success)
        self.assertTrue(ours["has_ridge"])
        self.assertEqual(ours["errors"], [None, None])
        for k in range(2):
            self.near(ours["coefficients"][k], beta[k], relative=1e-9)
        self.near(ours["intercept"], beta[2], relative=1e-9, absolute=1e-9)

    def test_a_term_that_does_not_vary(self):
        terms, success = self.made(200)
        terms[:, 1] = 5
        beta, errors = self.fit(terms[:, :1], success, 0)
        ours = ask_one("logistic", terms=terms.ravel(), count=2, success=success)
        self.near(ours["coefficients"][0], beta[0], relative=1e-9)
        self.near(ours["errors"][0], errors[0], relative=1e-9)
        self.assertEqual(ours["coefficients"][1], 0)
        self.assertIsNone(ours["errors"][1])
        self.near(ours["intercept"], beta[1], relative=1e-9)

    def test_without_a_success_or_a_failure(self):
        for success in (True, False):
            ours = ask_one("logistic", terms=[1.0, 2.0, 3.0], count=1, success=[success] * 3)
            self.assertFalse(ours["is_fitted"])
            self.assertEqual(ours["coefficients"], [0])


class Resampling(Case):
    RESAMPLES, SAMPLE = 20_000, 40

    def setUp(self):
        super().setUp()
        self.values = self.random.exponential(2, 300)

    def ask(self, seed):
        return ask_one("resampled", values=self.values, sample=self.SAMPLE, resamples=self.RESAMPLES, seed=seed)

    def test_samples_are_those_of_split_mix(self):
        """Steele, Lea & Flood 2014, written out again."""
        word, state = (1 << 64) - 1, 7

        def number():
            nonlocal state
            state = state + 0x9E3779B97F4A7C15 & word
            z = (state ^ state >> 30) * 0xBF58476D1CE4E5B9 & word
            z = (z ^ z >> 27) * 0x94D049BB133111EB & word
            return ((z ^ z >> 31) >> 11) / 2**53

        ours = self.ask(7)["values"]
        for k in range(100):
            sample = [self.values[int(number() * len(self.values))] for _ in range(self.SAMPLE)]
            self.near(ours[k], sum(sample) / self.SAMPLE)

    def test_means_scatter_as_those_of_another_hand(self):
        ours = self.ask(3)
        deviation = self.values.std() / math.sqrt(self.SAMPLE)
        # five standard errors, of a mean and of a deviation
        error = deviation / math.sqrt(self.RESAMPLES)
        self.near(float(numpy.mean(ours["values"])), self.values.mean(), relative=0, absolute=5 * error)
        self.near(float(numpy.std(ours["values"])), deviation, relative=5 / math.sqrt(2 * self.RESAMPLES))
        theirs = self.random.choice(self.values, (self.RESAMPLES, self.SAMPLE)).mean(axis=1)
        # the standard error of a percentile is sqrt(q (1 - q) / n) over the density there. These means are skewed: at their ends
        # they have more than two thirds of a normal density. Both hands have such an error
        density = stats.norm.pdf(stats.norm.ppf(0.025)) / deviation / 1.5
        error = math.sqrt(2 * 0.025 * 0.975 / self.RESAMPLES) / density
        for value, share in zip(ours["interval"], (2.5, 97.5)):
            self.near(value, float(numpy.percentile(theirs, share)), relative=0, absolute=5 * error)
        for value, share in zip(ours["interval"], (2.5, 97.5)):
            self.near(value, float(numpy.percentile(ours["values"], share)))


class Sensitivity(Case):
    BINS, GROUPS = 16, 20

    def test_indices_of_two_samples(self):
        a, b = self.random.random((3000, 2)), self.random.random((3000, 2))

        def model(x):
            return 50 + x[:, 0] + x[:, 0] * x[:, 1] ** 2

        mixed = []
        for i in range(2):
            rows = a.copy()
            rows[:, i] = b[:, i]
            mixed.append(model(rows))
        answers = numpy.concatenate([model(a), model(b)])
        for ours, one in zip(ask_one("sobol", a=model(a), b=model(b), mixed=[one.tolist() for one in mixed]), mixed):
            # Saltelli 2010, Table 2 (b)
            self.near(ours["first"], ((model(b) - answers.mean()) * (one - model(a))).mean() / answers.var(), absolute=1e-10)
            self.assertTrue(ours["interval"][0] < ours["first"] < ours["interval"][1])

    def index(self, inputs, outputs):
        """Epsilon squared by the textbook, in two passes."""
        bins = numpy.floor(self.BINS * inputs).astype(int)
        groups = [outputs[bins == k] for k in range(self.BINS) if (bins == k).any()]
        between = sum(len(group) * (group.mean() - outputs.mean()) ** 2 for group in groups)
        within = sum(((group - group.mean()) ** 2).sum() for group in groups) / (len(outputs) - len(groups))
        return (between - (len(groups) - 1) * within) / ((outputs - outputs.mean()) ** 2).sum()

    def test_indices_of_given_data(self):
        inputs = self.random.random((1507, 3))  # groups of two sizes
        outputs = numpy.column_stack([1e4 + 2 * inputs[:, 0] + inputs[:, 1] + self.random.normal(0, 0.3, len(inputs)),
                                      inputs[:, 2] ** 2 * (inputs[:, 0] > 0.5)])
        outputs[::7, 1] = math.nan
        ours = ask_one("given_data", inputs=inputs, outputs=outputs)
        for k in range(2):
            there = numpy.isfinite(outputs[:, k])
            y, group = outputs[there, k], numpy.arange(there.sum()) % self.GROUPS
            for i in range(3):
                x = inputs[there, i]
                # differences from the first value, and so of some thousand sums
                self.near(ours[k][i]["first"], self.index(x, y), relative=0, absolute=1e-10)
                without = numpy.array([self.index(x[group != g], y[group != g]) for g in range(self.GROUPS)])
                deviation = math.sqrt((self.GROUPS - 1) / self.GROUPS * ((without - without.mean()) ** 2).sum())
                half = stats.t.ppf(0.975, self.GROUPS - 1) * deviation
                for value, sign in zip(ours[k][i]["interval"], (-1, 1)):
                    self.near(value, self.index(x, y) + sign * half, relative=0, absolute=1e-9)

    def test_of_too_few_and_of_a_constant(self):
        inputs = self.random.random((159, 1))
        few = ask_one("given_data", inputs=inputs, outputs=inputs)[0][0]
        self.assertEqual(few, {"first": None, "interval": [None, None]})
        constant = ask_one("given_data", inputs=self.random.random((200, 1)), outputs=numpy.full((200, 1), 0.1))[0][0]
        self.assertEqual(constant, {"first": 0, "interval": [None, None]})


POINTS = [f"thumb_{point}" for point in ("cmc", "mcp", "ip", "tip")] + [
    f"{finger}_{point}" for finger in ("index", "middle", "ring", "little") for point in ("cmc", "mcp", "pip", "dip", "tip")]


def bits(mask):
    return [mask >> k & 1 for k in range(len(POINTS))]


def correlation(x, y):
    """None where one of them is the same for all, or where there are fewer than three."""
    return stats.pearsonr(x, y)[0] if len(x) > 2 and len(set(x)) > 1 and len(set(y)) > 1 else None


def share(part, all_of_it):
    return part / all_of_it if all_of_it else None


class Contacts(Case):
    def made(self, count, held=0.8):
        grasps = []
        for _ in range(count):
            touch = int(self.random.integers(0, 1 << 24)) & int(self.random.integers(0, 1 << 24)) | 1 << 13  # one always touches,
            touch &= ~(1 << 20)  # and one never
            roles = self.random.integers(0, 6, 24)  # of six, three have a name; each point has one
            masks = [sum(1 << k for k in range(24) if roles[k] == role and touch >> k & 1 and self.random.random() < 0.3)
                     for role in range(3)]
            grasps.append({"height": self.random.normal(0.06, 0.02), "distance": self.random.exponential(0.01), "touch": touch,
                           "tip": masks[0], "finger": masks[1], "inner": masks[2], "used": int(self.random.integers(1, 32)),
                           "held": bool(self.random.random() < held), "plausible": bool(self.random.random() < 0.7)})
        return grasps

    def expected(self, grasps):
        held = [grasp for grasp in grasps if grasp["held"]]
        height, distance = ([grasp[key] for grasp in held] for key in ("height", "distance"))
        fingers, points = ([bin(grasp[key]).count("1") for grasp in held] for key in ("used", "touch"))
        roles = ("tip", "finger", "inner")
        counts = {role: [bin(grasp[role]).count("1") for grasp in held] for role in roles}
        projected = [sum(of_grasp) for of_grasp in zip(*counts.values())]
        values = {("held_share", ""): share(len(held), len(grasps)),
                  ("plausible_share", ""): share(sum(grasp["plausible"] for grasp in held), len(held)),
                  ("mean_fingers", ""): share(sum(fingers), len(held)), ("mean_points", ""): share(sum(points), len(held)),
                  ("projected_share", ""): share(sum(count > 0 for count in projected), len(held))}
        for name, numbers in (("fingers", fingers), ("points", points)):
            values[f"pearson_{name}_height", ""] = correlation(height, numbers)
            values[f"pearson_{name}_distance", ""] = correlation(distance, numbers)
        for role in roles:
            values[f"projected_{role}_share", ""] = share(sum(counts[role]), sum(projected))
            values[f"grasps_projected_{role}_share", ""] = share(sum(count > 0 for count in counts[role]), len(held))
        for k, point in enumerate(POINTS):
            touches = [bits(grasp["touch"])[k] for grasp in held]
            values["touch_share", point] = share(sum(touches), len(held))
            values["point_biserial_height", point] = correlation(height, touches)
            values["point_biserial_distance", point] = correlation(distance, touches)
        return values

    def test_every_statistic_of_the_tally(self):
        for grasps in (self.made(500), self.made(17), self.made(2), self.made(3, held=0), []):
            ours = {(name, subject): value for name, subject, value in ask_one("tally", grasps=grasps)}
            theirs = self.expected(grasps)
            self.assertEqual(set(ours), set(theirs))
            for key, value in theirs.items():
                self.near(ours[key], value, absolute=ROUNDING, what=f"{key} of {len(grasps)}")


if __name__ == "__main__":
    unittest.main()
