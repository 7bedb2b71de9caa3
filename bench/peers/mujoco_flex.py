"""MuJoCo: a flex of dimension one, whose edges are any springs one likes as long as all are of one material."""

import mujoco
import numpy as np


def make(network, threads):
    return Peer(network)


class Peer:
    def __init__(self, network):
        self.model = mujoco.MjModel.from_xml_string(xml(network))
        self.data = mujoco.MjData(self.model)
        # A free point is a body of its own with three slides; a pinned one belongs to the world and has none.
        first = self.model.body_dofadr[self.model.flex_vertbodyid]
        free = network.inverse_mass > 0
        self.velocity = np.zeros(self.model.nv)
        self.velocity[first[free][:, None] + np.arange(3)] = network.velocity[free]
        self.reset()

    def reset(self):
        mujoco.mj_resetData(self.model, self.data)
        self.data.qvel = self.velocity

    def step(self, n):
        mujoco.mj_step(self.model, self.data, n)

    def positions(self):
        mujoco.mj_kinematics(self.model, self.data)
        mujoco.mj_flex(self.model, self.data)
        return self.data.flexvert_xpos


def xml(network):
    pins = listed(np.flatnonzero(network.inverse_mass == 0))
    mass = network.points / float(network.inverse_mass.max())
    return f"""
    <mujoco>
      <option timestep="{float(network.dt)!r}" gravity="0 {float(network.gravity)!r} 0" integrator="Euler">
        <flag contact="disable" constraint="disable"/>
      </option>
      <worldbody>
        <flexcomp name="network" type="direct" dim="1" mass="{mass!r}" radius="0.01"
                  point="{listed(network.position.astype(float))}" element="{listed(network.ends)}">
          <edge equality="false" stiffness="{network.stiffness[0]}" damping="{network.damping[0]}"/>
          <contact contype="0" conaffinity="0" selfcollide="none"/>
          {f'<pin id="{pins}"/>' if pins else ""}
        </flexcomp>
      </worldbody>
    </mujoco>"""


def listed(array):
    """All digits of all numbers."""
    return " ".join(map(repr, array.ravel().tolist()))
