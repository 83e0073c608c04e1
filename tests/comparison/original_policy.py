# SPDX-License-Identifier: Apache-2.0
"""Plays a policy that Shoal trained in the original environment: its physics, its renderer.

usage: original_policy.py POLICY.onnx DESCRIPTION.json ENVIRONMENT EPISODES SEED FILE

POLICY.onnx: `shoal export CHECKPOINT --onnx POLICY.onnx`. DESCRIPTION.json: `shoal env describe TASK
--json DESCRIPTION.json`, for where the cameras stand and what the blocks are. ENVIRONMENT: the
original's name, as FetchReachDense-v4. Writes what the policy earned there. Wants onnxruntime and
gymnasium-robotics, and MUJOCO_GL=osmesa where there is no display.
"""

import json
import sys

import gymnasium
import gymnasium_robotics  # noqa: F401  registers the environments
import mujoco
import numpy as np
import onnxruntime


class Cameras:
    """The policy's own cameras in the original scene, as planes (C, H, W)."""

    def __init__(self, env, views, height, width):
        self.env = env.unwrapped
        self.renderer = mujoco.Renderer(self.env.model, height, width)
        self.cameras = []
        for view in views:
            camera = mujoco.MjvCamera()
            camera.type = mujoco.mjtCamera.mjCAMERA_FREE
            camera.lookat[:] = view["lookat"]
            camera.distance = view["distance"]
            camera.azimuth = view["azimuth"]
            camera.elevation = view["elevation"]
            self.cameras.append(camera)

    def frame(self):
        self.env._render_callback()  # puts the goal's marker where the goal is
        planes = []
        for camera in self.cameras:
            self.renderer.update_scene(self.env.data, camera)
            planes.append(self.renderer.render().transpose(2, 0, 1))
        return np.concatenate(planes)


class Policy:
    def __init__(self, path, description, env):
        self.session = onnxruntime.InferenceSession(path, providers=["CPUExecutionProvider"])
        metadata = self.session.get_modelmeta().custom_metadata_map
        if metadata.get("goal_picture") == "1":
            raise SystemExit("the policy sees a goal picture, which the original environment does not draw")
        self.stack = int(metadata["stack"])
        self.shapes = {port.name: port.shape[1:] for port in self.session.get_inputs()}
        sizes = [block["size"] for block in description["state_blocks"]]
        names = [block["name"] for block in description["state_blocks"]]
        self.blocks = dict(zip(names, zip(np.cumsum([0] + sizes), sizes)))
        self.cameras = None
        if "pixels" in self.shapes:
            views = {view["name"]: view for view in description["cameras"]}
            names = metadata["cameras"].split(",")
            _, height, width = self.shapes["pixels"]
            self.cameras = Cameras(env, [views[name] for name in names], height, width)

    def begin(self):
        self.frames = []

    def act(self, observation):
        inputs = {}
        for name, shape in self.shapes.items():
            if name == "pixels":
                frame = self.cameras.frame()
                self.frames = (self.frames or [frame] * self.stack)[1:] + [frame]
                value = np.concatenate(self.frames)
            elif name in observation:  # a goal, or the whole state
                value = observation[name].astype(np.float32)
            else:
                first, size = self.blocks[name]
                value = observation["observation"][first:first + size].astype(np.float32)
            inputs[name] = value[np.newaxis].reshape([1] + list(shape))
        return self.session.run(["action"], inputs)[0][0]


def play(env, policy, seed):
    observation, _ = env.reset(seed=seed)
    policy.begin()
    total, ended = 0.0, False
    while not ended:
        observation, reward, terminated, truncated, info = env.step(policy.act(observation))
        total += float(reward)
        ended = terminated or truncated
    distance = np.linalg.norm(observation["achieved_goal"] - observation["desired_goal"])
    return {"seed": seed, "return": total, "success": bool(info["is_success"]),
            "final_distance": float(distance)}


def main():
    if len(sys.argv) != 7:
        sys.exit(__doc__)
    path, description, name, episodes, seed, file = sys.argv[1:]
    with open(description, encoding="utf-8") as text:
        description = json.load(text)
    env = gymnasium.make(name)
    policy = Policy(path, description, env)
    played = [play(env, policy, 1000 * int(seed) + k) for k in range(int(episodes))]
    result = {
        "environment": name,
        "versions": {
            "gymnasium-robotics": gymnasium_robotics.__version__,
            "mujoco": mujoco.__version__,
            "onnxruntime": onnxruntime.__version__,
        },
        "policy": policy.session.get_modelmeta().custom_metadata_map,
        "success_rate": np.mean([episode["success"] for episode in played]),
        "return_mean": np.mean([episode["return"] for episode in played]),
        "final_distance_mean": np.mean([episode["final_distance"] for episode in played]),
        "episodes": played,
    }
    with open(file, "w", encoding="utf-8") as out:
        json.dump(result, out, indent=1)
        out.write("\n")
    print(f"success {100 * result['success_rate']:.1f} % of {len(played)}, "
          f"final distance {100 * result['final_distance_mean']:.2f} cm, "
          f"return {result['return_mean']:.2f}")


if __name__ == "__main__":
    main()
