"""How an aircraft's height changes from one fix to the next: by a vertical speed, or by a trained network."""

import equinox as eqx
import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Float, Int

MOST = 2.0  # scaled inputs of the network are clipped to this; 1 is half of the training range


class Climb(eqx.Module):
    """h⁺ = h + climb Δt with the mean climb rate of both ends, or h⁺ = h + the change of another height.

    The step of Wang S. et al. without a network. `columns`: one, of a vertical speed [m/s], or of a height [m] where
    `speed` is False. `upward`: 1 or -1.
    """

    upward: Float[Array, ""]
    columns: tuple[int, ...] = eqx.field(static=True)
    speed: bool = eqx.field(static=True, default=True)

    def rolled(
        self,
        height: Float[Array, " L"],
        inputs: Float[Array, "P U"],
        time: Float[Array, " P"],
        steps: Int[Array, " M"],
    ) -> Float[Array, " M"]:
        """The height now [m], rolled out over the last `steps` of L steps; `inputs` and `time` end with the present."""
        x = self.upward * inputs[:, 0]
        # h(k+1) = h(k) - v_d Δt
        gained = (x[1:] + x[:-1]) / 2 * jnp.diff(time) if self.speed else jnp.diff(x)
        ahead = jnp.cumsum(gained[::-1])
        return height[height.size - steps] + ahead[steps - 1]


class StepNetwork(eqx.Module):
    """h⁺ = h + unit Δt / period f(h, inputs): the observer of Wang S. et al., with f their network of one step.

    Layers: all inputs scaled by their training range, hidden ReLU units, linear output. Step j of a roll-out uses
    weight set j, or the last set if there are fewer: with a single set all steps share it. The network gives the
    increment of one period; for absolute heights it would have to copy its input.
    """

    weights: Float[Array, "J H V"]
    bias: Float[Array, "J H"]
    output: Float[Array, "J H"]
    offset: Float[Array, " J"]
    center: Float[Array, " V"]  # middle of the training range: height, then inputs [SI]
    half: Float[Array, " V"]  # half of it [SI]
    unit: Float[Array, ""]  # [m]
    period_s: Float[Array, ""]
    columns: tuple[int, ...] = eqx.field(static=True)

    def rolled(
        self,
        height: Float[Array, " L"],
        inputs: Float[Array, "P U"],
        time: Float[Array, " P"],
        steps: Int[Array, " M"],
    ) -> Float[Array, " M"]:
        """The height now [m], rolled out over the last `steps` of L steps; `inputs` and `time` end with the present."""
        begun = height.size - steps

        def step(h: Float[Array, " M"], row: tuple[Array, Array, Array, Array]) -> tuple[Float[Array, " M"], None]:
            i, measured, now, dt = row
            # ĥ(k-N+1) starts from the measured h(k-N), all later ones from the ĥ before
            h = jnp.where(i == begun, measured, h)
            return h + self.gain(h, now, dt, i - begun), None

        rows = jnp.arange(height.size), height, inputs[:-1], jnp.diff(time)
        return lax.scan(step, jnp.zeros(steps.shape, height.dtype), rows)[0]

    def gain(
        self, h: Float[Array, " M"], inputs: Float[Array, " U"], dt: Float[Array, ""], j: Int[Array, " M"]
    ) -> Float[Array, " M"]:
        """Change of the height [m] in step j of length `dt` [s], from heights h [m]."""
        j = jnp.clip(j, 0, self.offset.size - 1)
        seen = jnp.concatenate([h[:, None], jnp.tile(inputs, (h.size, 1))], axis=1)
        x = jnp.clip((seen - self.center[None]) / self.half[None], -MOST, MOST)
        hidden = jax.nn.relu((self.weights[j] * x[:, None]).sum(axis=2) + self.bias[j])
        return ((self.output[j] * hidden).sum(axis=1) + self.offset[j]) * (self.unit / self.period_s * dt)
