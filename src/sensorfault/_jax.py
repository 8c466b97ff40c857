"""JAX as this package needs it: float64, and steps run on the calling thread.

Handing a 20 microsecond step to another thread costs more than the step.
"""

import jax

jax.config.update("jax_enable_x64", True)  # type: ignore[no-untyped-call]
jax.config.update("jax_cpu_enable_async_dispatch", False)  # type: ignore[no-untyped-call]
