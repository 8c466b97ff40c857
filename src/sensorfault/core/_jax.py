"""JAX as this package needs it: float64, steps on the calling thread of a CPU, small loops compiled as one function.

Must come before JAX's first computation; after it these settings only change speed and precision.
"""

import os

# A loop that touches less than this in a round becomes one function; by default XLA dispatches its small operations one
# by one and hands some to other threads, and waking those costs more than a whole step (an hour of 50 Hz: 0.8 against
# 0.3 s; a live step: 130 against 30 us). A program that sets XLA_FLAGS' extra options itself is left alone.
_SMALL = "--xla_backend_extra_options=xla_cpu_small_while_loop_byte_threshold=1000000"
if "xla_backend_extra_options" not in os.environ.get("XLA_FLAGS", ""):
    os.environ["XLA_FLAGS"] = f"{os.environ.get('XLA_FLAGS', '')} {_SMALL}".strip()

import jax  # noqa: E402

jax.config.update("jax_enable_x64", True)  # type: ignore[no-untyped-call]
# Handing a step of 20 microseconds to another thread costs more than the step.
jax.config.update("jax_cpu_enable_async_dispatch", False)  # type: ignore[no-untyped-call]
# A log through a monitor is a chain of small steps, for which a GPU takes twelve to thirty times as long. It gains
# where many run at once, and computes what is put there (jax.device_put, or with jax.default_device).
if not jax.config.jax_platforms and jax.config.jax_default_device is None:  # type: ignore[attr-defined]
    jax.config.update("jax_default_device", "cpu")  # type: ignore[no-untyped-call]
