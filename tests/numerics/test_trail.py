"""A trail keeps the newest places, carries them on, and forgets them all at once."""

import jax.numpy as jnp
import numpy as np

from sensorfault.numerics.trail import Trail


def f(number: float):
    return jnp.asarray(float(number))


def walked(steps: int, slots: int = 4) -> Trail:
    """A place a second, each named by its second, after a metre north in each."""
    trail = Trail.empty(slots)
    for k in range(steps):
        trail = trail.carried(f(1.0), jnp.asarray([0.0, 1.0]), f(1.0))
        trail = trail.put(jnp.asarray(True), f(k), f(-k), jnp.asarray([0.0, 1.0]), f(1.0))
    return trail


def test_the_newest_come_first_and_the_oldest_drop_out() -> None:
    trail = walked(6)
    np.testing.assert_array_equal(trail.latitude, [5, 4, 3, 2])
    np.testing.assert_array_equal(trail.age, [0, 1, 2, 3])
    np.testing.assert_array_equal(trail.way[:, 1], [0, 1, 2, 3])
    np.testing.assert_array_equal(trail.path, [0, 1, 2, 3])
    assert trail.there.all()


def test_the_newest_that_is_old_enough_is_picked() -> None:
    trail = walked(6)
    for least, latitude in ((0.0, 5), (1.0, 4), (1.5, 3), (3.0, 2)):
        place = trail.pick(trail.newest(f(least)))
        assert place.there
        assert place.latitude == latitude
    nobody = trail.pick(trail.newest(f(3.5)))
    assert not nobody.there
    assert nobody.latitude == 0


def test_a_place_too_soon_after_the_last_is_not_kept() -> None:
    trail = walked(2).carried(f(0.5), jnp.zeros(2), f(0.0))
    same = trail.put(jnp.asarray(True), f(9), f(9), jnp.zeros(2), f(1.0))
    np.testing.assert_array_equal(same.latitude, trail.latitude)
    np.testing.assert_array_equal(same.age, trail.age)


def test_forgetting_leaves_nothing_behind() -> None:
    gone = walked(6).kept(jnp.asarray(False))
    assert not gone.there.any()
    for field in gone[:-1]:
        assert not np.asarray(field).any()
    fresh = gone.put(jnp.asarray(True), f(7), f(8), jnp.zeros(2), f(1.0))
    np.testing.assert_array_equal(fresh.there, [True, False, False, False])
