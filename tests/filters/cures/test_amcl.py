import math
from dataclasses import replace

import numpy as np
import pytest
from problems import ROOM, anywhere, begun, classroom
from scenes import DESK, scene, world
from scipy.stats import chi2, chisquare, norm
from shapely import Polygon, box

from ekfsim import load_world
from ekfsim.commands import Kidnap, Move, Sense
from ekfsim.errors import InputError, UsageError
from ekfsim.files.packaged import packaged
from ekfsim.filters.belief import Gaussian, Particles, Refused
from ekfsim.filters.cures.amcl import AMCL, FAST, SLOW, UNEXPLAINED, followed
from ekfsim.filters.particles.drawing import Source, drawn_anew
from ekfsim.filters.particles.kld import FEWEST, KLD, bins, cells, enough, occupied
from ekfsim.filters.pf import PF
from ekfsim.filters.protocol import Beginning
from ekfsim.localization import belief_of, play
from ekfsim.models.sensors.laser import Laser
from ekfsim.scene import Scene


def one(seed=0, count=500, **settings):
    return AMCL((np.random.default_rng(seed),), count=count, anywhere=anywhere, **settings)


def carried(filter="amcl", count=2000):
    """Some readings, a kidnapping, and twelve more."""
    away = (Sense(0.0), Sense(2.1), Sense(-2.1), Move(0.5, 0.7))
    course = (Move(1.0, 0.0), Sense(0.0), Sense(1.5), Kidnap(7.0, 5.5, 2.0), *4 * away)
    made = scene(*course, start=(1.5, 1.5, 0.3), obstacles=(DESK,), seed=3, filter=filter)
    return replace(made, tuning=replace(made.tuning, particles=count))


@pytest.mark.parametrize("k", [2, 3, 10, 100, 5000])
def test_as_many_are_enough_as_the_divergence_asks_for(k):
    """χ²_{k−1} at 99 % over 2 ε is the number; Wilson and Hilferty's cube is within 1 % of it."""
    exact = chi2.ppf(0.99, k - 1) / (2 * KLD)
    a = 2 / (9 * (k - 1))
    cube = (k - 1) / (2 * KLD) * (1 - a + math.sqrt(a) * norm.ppf(0.99)) ** 3
    assert enough(k) == max(FEWEST, math.ceil(cube))
    assert cube == pytest.approx(exact, rel=0.02)


def test_places_are_bins_that_hold_some():
    states = np.array([[0.1, 0.1, 0.01], [0.15, 0.05, 0.02], [0.1, 0.1, -0.01], [-0.1, 0.1, 0.01]])
    assert len(set(cells(states, bins(3, (2,))).tolist())) == 3
    assert bins(3, (2,)) == pytest.approx([0.2, 0.2, math.radians(5)])


@pytest.mark.parametrize("N", [10, 40, 200])
def test_what_few_say_is_itself_in_doubt(N):
    """Of N draws of a Gaussian the next one is t-distributed about their mean (numpy draws them, no
    formula of ours): what is drawn anew covers it, on average over many such N."""
    generator = np.random.default_rng(N)
    outside = []
    for _ in range(400):
        states = generator.normal(size=(N, 3))
        mean, P = states.mean(axis=0), np.cov(states.T, ddof=0)
        L = np.linalg.cholesky(P)
        source = Source(
            np.arange(1, N + 1) / N, mean, states - mean, L, wide=0.0, astray=0.0, alike=N
        )
        b, β = source.kernel(300)
        # the covariance of what is drawn, over that of the N
        grown = 1 - b * b + β * β
        expected = (N + 1) / (N - 5) if N - 5 >= 6 else 2.0
        assert grown == pytest.approx(expected)
        next_one = generator.normal(size=3) - mean
        outside.append(next_one @ np.linalg.solve(grown * P, next_one))
    assert np.mean(outside) == pytest.approx(3, rel=0.25)
    (drawn,) = drawn_anew([generator], [source], (2,), 5000, anywhere)
    assert np.cov(drawn.T) == pytest.approx(grown * P, abs=0.5 * grown)
    assert drawn.mean(axis=0) == pytest.approx(mean, abs=0.4)


def test_drawn_side_by_side_each_run_is_as_alone():
    """Those that need more than the others, and those of which some go astray, among them."""
    generator = np.random.default_rng(7)
    of_runs = []
    for N, σ, astray in [(300, 0.01, 0.0), (400, 1.0, 0.3), (350, 0.5, 0.0), (300, 0.02, 0.9)]:
        away = generator.normal(scale=σ, size=(N, 3))
        ends = np.cumsum(generator.random(N))
        of_runs.append(Source(ends, np.ones(3), away, σ * np.eye(3), 0.0, astray, N))
    fresh = [np.random.default_rng(i) for i in range(4)]
    together = drawn_anew(fresh, of_runs, (2,), 2000, anywhere)
    numbers = [len(of_run) for of_run in together]
    assert numbers[0] == 300
    assert min(numbers[1:]) > 300
    for i, of_run in enumerate(together):
        its_own = np.random.default_rng(i)
        (alone,) = drawn_anew([its_own], [of_runs[i]], (2,), 2000, anywhere)
        assert np.array_equal(of_run, alone)
        assert fresh[i].random() == its_own.random()


def test_occupied_bins_are_counted_as_a_set_counts_them():
    places = np.random.default_rng(3).integers(-40, 40, size=(5, 60))
    assert occupied(places).tolist() == [len(set(row)) for row in places.tolist()]
    assert occupied(np.array([4])) == 1


def test_averages_by_hand():
    """w = min(1, P/p₀) of a reading whose probability is 1e-4: 0.1."""
    w = min(1.0, 1e-4 / UNEXPLAINED)
    assert followed(np.array(1.0), np.array(w), FAST) == pytest.approx(1 - 0.9 * FAST)
    assert followed(np.array([1.0, 0.5]), np.array([np.nan, 1.0]), SLOW) == pytest.approx(
        [1.0, 0.5 + 0.5 * SLOW]
    )
    first, laser, _ = classroom(np.random.default_rng(1))
    filter = one()
    belief, told = filter.update(first, laser, laser.h(first.mean))
    assert belief.astray == pytest.approx(0, abs=1e-12)
    belief, told = filter.update(belief, laser, laser.h(belief.mean) / 2)
    w = min(1.0, chi2.sf(told.nis, 1) / UNEXPLAINED)
    slow, fast = 1 - SLOW * (1 - w), 1 - FAST * (1 - w)
    assert (belief.slow, belief.fast) == pytest.approx((slow, fast))
    assert belief.astray == pytest.approx(1 - fast / slow)
    assert 0.3 < belief.astray < 1


def test_what_the_gate_refuses_was_not_explained_either():
    first, laser, _ = classroom(np.random.default_rng(1))
    belief, told = one(gate=0.999).update(first, laser, laser.h(first.mean) / 2)
    assert told.refused == Refused.GATE
    assert belief.fast < 0.6
    belief, _ = one().update(first, laser, np.array([np.nan]))  # no echo tells nothing
    assert (belief.slow, belief.fast) == (1, 1)


def test_the_sure_need_few_and_the_unsure_many():
    filter = one(count=5000)
    numbers = []
    for σ in (0.05, 1.0):
        prior = Gaussian(np.array([5.0, 4.0, 0.3]), np.diag([σ, σ, 0.3 * σ]) ** 2)
        sharp = Laser(ROOM, 0.0, 0.001)
        numbers.append(int(filter.update(prior, sharp, sharp.h(prior.mean))[0].number))
    assert FEWEST <= numbers[0] < 500 < numbers[1] <= 5000


def test_a_run_is_the_same_alone_as_among_others():
    """To the bit, however many particles the others have, and wherever theirs are drawn from."""
    whole = list(play(carried(), np.arange(8)))
    alone = list(play(replace(carried(), run=3)))
    numbers = set()
    for among, own in zip(whole[1:], alone[1:], strict=True):
        assert (among.posterior.mean[3] == own.posterior.mean).all()
        assert (among.posterior.covariance[3] == own.posterior.covariance).all()
        number = int(own.posterior.number)
        assert (among.posterior.states[3, :number] == own.posterior.states[:number]).all()
        assert (among.posterior.weights[3, number:] == 0).all()
        numbers |= set(among.posterior.number.tolist())
    assert len(numbers) > 5
    assert whole[4].posterior.astray.max() >= 0


def test_it_comes_back_where_others_stay_lost():
    """Twelve readings after it was carried away; bounds 4 deviations wide of 40 runs."""
    for filter, low, high in (("pf", 0.0, 0.25), ("amcl", 0.5, 1.0)):
        last = list(play(carried(filter), np.arange(40)))[-1]
        off = np.hypot(*(last.posterior.mean - last.entry.truth)[:, :2].T)
        assert low <= np.mean(off < 0.5) <= high, filter


def test_anywhere_is_uniform_over_the_free_floor():
    """Cells of 2 m by 2 m hold particles in proportion to their free areas, and so do headings."""
    made = world(obstacles=(DESK,))
    poses = made.anywhere(np.random.default_rng(5), 40_000)
    free = box(0, 0, 10, 8).difference(Polygon(DESK.points))
    corners = [(x, y) for x in range(0, 10, 2) for y in range(0, 8, 2)]
    areas = np.array([free.intersection(box(x, y, x + 2, y + 2)).area for x, y in corners])
    held = np.array(
        [np.sum((poses[:, :2] // 2 == (x // 2, y // 2)).all(axis=1)) for x, y in corners]
    )
    assert chisquare(held, areas / areas.sum() * 40_000).pvalue > 1e-4
    headings = np.histogram(poses[:, 2], bins=12, range=(-math.pi, math.pi))[0]
    assert chisquare(headings).pvalue > 1e-4
    assert held.sum() == headings.sum() == 40_000


def test_where_no_wall_ends_the_floor_it_is_refused():
    first = Gaussian(np.zeros(3), np.eye(3))
    generators = lambda: [np.random.default_rng(0)]  # noqa: E731
    with pytest.raises(UsageError, match="a map with a boundary, and there is none; take pf"):
        AMCL.begin(Beginning(first, generators=generators))
    with pytest.raises(ValueError, match="needs generators"):
        AMCL.begin(Beginning(first, anywhere=anywhere))


@pytest.mark.parametrize("weight", [0.0, math.nan])
def test_weights_that_say_nothing_are_an_error_not_a_draw(weight):
    states = np.tile([5.0, 4.0, 0.0], (100, 1))
    nothing = np.full(100, weight)
    crowd = one()._crowd(Particles(states[0], np.eye(3), states, nothing))
    with pytest.raises(ValueError, match="particle 1 has the weight"):
        one()._redrawn(crowd, np.array(True))


def test_a_first_belief_is_a_crowd_that_stands_for_itself():
    """Of as many particles as its bins ask for."""
    first, _, motion = classroom(np.random.default_rng(2))
    numbers = []
    for smaller in (1e-4, 0.3, 1.0):
        start = Gaussian(first.mean, smaller * first.covariance)
        moved, made = begun("amcl", start).predict(start, motion, np.zeros(2))
        assert moved.mean == pytest.approx(first.mean, abs=0.05)
        assert pytest.approx(np.eye(3)) == made.F
        numbers.append(int(moved.number))
    assert FEWEST == numbers[0] < numbers[1] < numbers[2] <= 5000


def test_a_sparse_particle_stands_for_those_about_it():
    """Where the robot may be anywhere, R becomes R + H C Hᵀ, C being what parts copies: each
    particle is weighed by the mean of what those about it say; and nothing is added of a crowd that
    is dense."""
    laser, z = Laser(ROOM, 0.0, 0.02), np.array([3.0])
    filter = one(count=400)
    generator = np.random.default_rng(7)
    states = anywhere(generator, 400)
    for σ, wide in ((None, True), (0.02, False)):
        if σ is not None:
            states = np.array([5.0, 4.0, 0.3]) + generator.normal(size=(400, 3)) * σ
        alike = filter._summed(states[None], np.full((1, 400), 1 / 400))
        C = filter._about(alike, np.array([400]))
        assert (C is not None) == wide
        if C is None:
            continue
        widths = np.sqrt(np.diagonal(C[0])) / bins(3, (2,))
        assert widths.max() == pytest.approx(1.5)
        weights, _, _ = PF(filter.generators, count=400)._weighed(
            alike, laser, z[None], np.array([False]), C
        )
        h, H, R = laser.linearize(states)
        spread = np.var(h)
        S = R[:, 0, 0] + (H @ C @ H.mT)[:, 0, 0] + spread * (10 / 400) ** 2
        expected = norm.pdf(z, h[:, 0], np.sqrt(S))
        assert weights[0] == pytest.approx(expected / expected.sum(), rel=1e-6)


def lost_at_first(filter="amcl", count=4000):
    """A robot in the furnished room that has no idea where it is, and looks about twelve times."""
    away = (Sense(0.0), Sense(2.1), Sense(-2.1), Move(0.5, 0.7))
    made = Scene(
        load_world(packaged("worlds")["furnished-room"]).with_("belief.start", "unknown"),
        4 * away, seed=3, filter=filter,
    )  # fmt: skip
    return replace(made, tuning=replace(made.tuning, particles=count))


def test_with_no_idea_at_all_the_crowd_is_all_over_the_floor():
    made = lost_at_first(count=3000)
    first = belief_of(made)
    walls = made.world.told.map.walls.ground
    assert walls.free(first.states[:, :2]).all()
    assert np.ptp(first.states, axis=0) == pytest.approx([10, 8, 2 * math.pi], abs=0.2)
    assert first.mean == pytest.approx([5, 4, 0])
    among = belief_of(made, np.arange(4)).states
    assert (among[0] == first.states).all()
    assert (among[1] != among[0]).any()


def test_it_finds_itself_from_no_idea_at_all():
    """Of 30 runs at least 20 within 0.3 m: 4 deviations below nine of ten."""
    last = list(play(lost_at_first(), np.arange(30)))[-1]
    off = np.hypot(*(last.posterior.mean - last.entry.truth)[:, :2].T)
    assert np.count_nonzero(off < 0.3) >= 20


def test_no_other_filter_begins_with_no_idea():
    made = lost_at_first("ekf")
    with pytest.raises(UsageError, match="ekf cannot begin where the start is unknown"):
        list(play(made))
    assert belief_of(lost_at_first("pf", 50)).states.shape == (50, 3)


@pytest.mark.parametrize(
    ("belief", "message"),
    [
        ("{start: unknow}", "belief.start: 'unknow' is not known here; did you mean 'unknown'?"),
        (
            "{start: unknown, sigma: {x: 1}}",
            "belief.sigma: nobody is sure to a sigma of a start that is unknown; delete either",
        ),
        (
            "{start: 3}",
            "belief.start: 3 is a number where a pose, or the word unknown belongs; "
            "write e.g. {x: 1.0, y: 1.0, theta: 90}, or unknown",
        ),
    ],
)
def test_a_start_that_cannot_be_unknown_is_told_in_a_line(belief, message, tmp_path):
    file = tmp_path / "w.yaml"
    file.write_text(
        "name: w\nboundary: [[0, 0], [4, 0], [4, 3]]\nstart: {x: 2, y: 1, theta: 0}\n"
        "noise: {executionDstSigmaRatio: 0, executionAngSigmaRatio: 0, odometryDstSigmaRatio: 0, "
        f"odometryAngSigmaRatio: 0, rangeSigmaRatio: 0}}\nbelief: {belief}\n"
    )
    with pytest.raises(InputError) as error:
        load_world(file)
    assert str(error.value).startswith(f"{file}:5:")
    assert message in str(error.value)
    assert "\n" not in str(error.value)
