"""JAX as this package needs it: float64, steps on the calling thread of a CPU, small loops compiled as one function.

Must come before JAX's first computation; after it these settings only change speed and precision.
"""

import os
import warnings
from contextlib import suppress

from sensorfault.core.compiled import Programs, Unusable, folder, machine

# A loop that touches less than this in a round becomes one function; by default XLA dispatches its small operations one
# by one and hands some to other threads, and waking those costs more than a whole step (an hour of 50 Hz: 0.8 against
# 0.3 s; a live step: 130 against 30 us). A program that sets XLA_FLAGS' extra options itself is left alone.
_SMALL = "--xla_backend_extra_options=xla_cpu_small_while_loop_byte_threshold=100000000"
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


def _keep_programs() -> None:
    """Compiled programs are kept on disk (see compiled.py). A program that keeps its own is left alone.

    JAX's own store neither checks what it reads nor bounds its size without another library, so ours takes its place;
    where a future JAX has no such place, everything runs as without a cache.
    """
    home = folder()
    if home is None or jax.config.jax_compilation_cache_dir:  # type: ignore[attr-defined]
        return
    programs = Programs(home)
    with suppress(Unusable, ImportError, AttributeError):
        from jax._src import compilation_cache
        from jax._src.compilation_cache_interface import CacheInterface

        programs.prepare()
        here = machine()

        class Store(CacheInterface):
            """JAX's view of our programs. The key says what was compiled and how; `here` says for which machine."""

            _path = home  # type: ignore[assignment]

            def get(self, key: str) -> bytes | None:
                return programs.get(f"{here} {key}")

            def put(self, key: str, value: bytes) -> None:
                programs.put(f"{here} {key}", value)

        jax.config.update("jax_compilation_cache_dir", str(home))  # type: ignore[no-untyped-call]
        jax.config.update("jax_persistent_cache_min_compile_time_secs", 0.0)  # type: ignore[no-untyped-call]
        jax.config.update("jax_persistent_cache_min_entry_size_bytes", -1)  # type: ignore[no-untyped-call]
        compilation_cache._cache, compilation_cache._cache_initialized = Store(), True
        # An entry that JAX cannot load is compiled again and replaced; the user need not know.
        warnings.filterwarnings("ignore", message="Error (reading|writing) persistent compilation cache")


_keep_programs()
