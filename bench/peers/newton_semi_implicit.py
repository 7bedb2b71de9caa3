"""Newton's semi-implicit solver on the processor, where Warp runs on one thread. It looks for no contacts."""

import tempfile

import newton
import warp as wp

# Every run compiles its kernels anew, so that set-up times tell the same story each time.
CACHE = tempfile.TemporaryDirectory()


def make(network, threads):
    wp.config.kernel_cache_dir = CACHE.name
    wp.config.quiet = True
    wp.set_device("cpu")
    return Peer(network)


class Peer:
    def __init__(self, network):
        self.network = network
        builder = newton.ModelBuilder(up_axis=newton.Axis.Y, gravity=(0.0, float(network.gravity), 0.0))
        mass = [1 / w if w > 0 else 0 for w in network.inverse_mass.tolist()]
        builder.add_particles(network.position.tolist(), network.velocity.tolist(), mass)
        laws = zip(network.stiffness.tolist(), network.damping.tolist(), strict=True)
        for (i, j), law in zip(network.ends.tolist(), laws, strict=True):
            builder.add_spring(i, j, *law, control=0.0)
        builder.spring_rest_length = network.rest_length.tolist()
        self.model = builder.finalize()
        self.model.particle_grid = None  # no contacts between particles
        self.solver = newton.solvers.SolverSemiImplicit(self.model)
        self.old, self.new = self.model.state(), self.model.state()
        self.control = self.model.control()
        self.dt = float(network.dt)

    def reset(self):
        self.old.particle_q.assign(self.network.position)
        self.old.particle_qd.assign(self.network.velocity)

    def step(self, n):
        for _ in range(n):
            self.old.clear_forces()
            self.solver.step(self.old, self.new, self.control, None, self.dt)
            self.old, self.new = self.new, self.old

    def positions(self):
        return self.old.particle_q.numpy()
