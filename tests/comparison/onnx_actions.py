# SPDX-License-Identifier: Apache-2.0
"""Holds ONNX Runtime to the actions of Shoal's own networks, on files that `shoal export` writes.

usage: onnx_actions.py SHOAL CHECKPOINT...

Exports each checkpoint (a folder) and runs the file by ONNX Runtime on the observations that went
into a file of samples: all at once, and one by one, as a robot would. Prints the largest difference
of an action for each and exits with 1 where one is above 1e-4. Wants onnx, onnxruntime, safetensors
and numpy from PyPI; nothing of Shoal needs Python. Checkpoints of every algorithm and encoder:

  build/release/bin/random-checkpoints /tmp/checkpoints
  onnx_actions.py build/release/bin/shoal /tmp/checkpoints/*/checkpoints/step_*
"""

import os
import subprocess
import sys
import tempfile

import numpy as np
import onnx
import onnxruntime
from safetensors.numpy import load_file

MOST = 1e-4


def largest_difference(model, samples):
    session = onnxruntime.InferenceSession(model, providers=["CPUExecutionProvider"])
    inputs = {port.name: samples[port.name] for port in session.get_inputs()}
    together = session.run(["action"], inputs)[0]
    one_by_one = [
        session.run(["action"], {name: value[n : n + 1] for name, value in inputs.items()})[0]
        for n in range(len(together))
    ]
    ours = samples["action"]
    assert together.shape == ours.shape and np.abs(together).max() <= 1
    return max(np.abs(together - ours).max(), np.abs(np.concatenate(one_by_one) - ours).max())


def main(shoal, checkpoints):
    worst = 0.0
    for checkpoint in checkpoints:
        with tempfile.TemporaryDirectory() as folder:
            model, samples = os.path.join(folder, "p.onnx"), os.path.join(folder, "p.safetensors")
            subprocess.run(
                [shoal, "export", checkpoint, "--onnx", model, "--samples", samples],
                check=True,
                stdout=subprocess.DEVNULL,
            )
            onnx.checker.check_model(model, full_check=True)
            difference = largest_difference(model, load_file(samples))
        print(f"{difference:.1e}  {checkpoint}", flush=True)
        worst = max(worst, difference)
    print(f"largest of {len(checkpoints)}: {worst:.1e} (ONNX Runtime {onnxruntime.__version__})")
    return 0 if worst <= MOST else 1


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1], sys.argv[2:]))
