# SPDX-License-Identifier: Apache-2.0
"""Records what torchvision's resnet18 and alexnet compute, for a test of ours to be held to.

usage: torchvision_encoders.py FOLDER

Writes KIND_C.safetensors to FOLDER for each kind and C channels of its images. The classifiers are
left off: what is compared are the numbers that enter them. Weights, images and the loss's
coefficients are not stored: both sides compute them from shared_numbers.py. Torch computes in
double, so that a difference is one side's rounding alone. Wants torch, torchvision and safetensors
from PyPI; nothing of Shoal needs Python.

One update in training mode of the loss sum(coefficient * features), by Adam with rate 1e-3 and
epsilon 0.1: with the usual one a first step would show the signs of gradients alone. Then one pass
in evaluation mode. Of each array n entries are kept (at most 256 of features, 48 of others;
those at floor(i size / n)) and behind them the Euclidean norm of all. NAME is a tensor's name in
torchvision:

  training.features     of training.images
  gradient.NAME
  after.NAME            parameters and running statistics after the update
  evaluation.features   of evaluation.images, with running statistics
"""

import os
import sys

import numpy as np
import torch
import torchvision
from safetensors.numpy import save_file
from shared_numbers import symmetric, uniform

BATCH = 4
# Channels, height and width: alexnet's last map is repeated to 6x6 from 1x1 and 2x3, and averaged
# over 7 columns to 6.
CASES = {
    "resnet18": [(1, 84, 84), (3, 70, 61), (4, 84, 84), (9, 84, 84)],
    "alexnet": [(1, 70, 255), (3, 84, 84), (4, 84, 84), (9, 97, 130)],
}


def build(kind, channels):
    if kind == "resnet18":
        model = torchvision.models.resnet18(weights=None)
        model.conv1 = torch.nn.Conv2d(channels, 64, 7, 2, 3, bias=False)
        model.fc = torch.nn.Identity()
    else:
        model = torchvision.models.alexnet(weights=None)
        model.features[0] = torch.nn.Conv2d(channels, 64, 11, 4, 2)
        model.classifier = torch.nn.Identity()
    return model.double()


def set_weights(model):
    """Convolutions U(+-sqrt(6 / inputs)), their biases and running means U(+-0.2), running variances
    1 + U(+-0.3). What batch normalisation makes of a channel has a deviation of about 0.3 and a mean
    far enough from 0 that of the million inputs of ReLUs hardly one is so close to 0 that two
    correct programs round it to different sides, which would change all gradients behind it."""
    tensors = {n: t for n, t in model.state_dict().items() if not n.endswith("num_batches_tracked")}
    with torch.no_grad():
        for name, tensor in tensors.items():
            inputs = tensor[0].numel() if tensor.dim() == 4 else 1
            numbers = symmetric(name, tensor.shape, (6 / inputs) ** 0.5 if tensor.dim() == 4 else 1)
            if name.endswith("bn1.bias"):
                numbers = torch.sign(numbers) * (1 + 0.2 * numbers.abs())
            elif name.endswith("bn2.bias"):
                numbers = torch.where(numbers < -0.5, -8.0, 2.0)
            elif name.endswith("downsample.1.bias"):
                numbers = 1 + 0.2 * numbers
            elif name.endswith(".running_var"):
                numbers = 1 + 0.3 * numbers
            elif name.endswith(".weight") and tensor.dim() == 1:
                numbers = 0.3 * (1 + 0.3 * numbers)
            elif tensor.dim() == 1:
                numbers = 0.2 * numbers
            tensor.copy_(numbers)
    return tensors


def images(name, shape):
    levels = np.floor(uniform(name, int(np.prod(shape))) * 256)
    return torch.from_numpy(levels.reshape(shape)) / 255


def picked(tensor, most):
    array = tensor.detach().numpy().astype(np.float64).reshape(-1)
    count = min(most, array.size)
    index = np.arange(count) * array.size // count
    return np.append(array[index], np.linalg.norm(array)).astype(np.float32)


def run(kind, channels, height, width, folder):
    model = build(kind, channels)
    tensors = set_weights(model)
    optimiser = torch.optim.Adam(model.parameters(), lr=1e-3, eps=0.1)
    shape = (BATCH, channels, height, width)
    file = {}
    model.train()
    features = model(images("training.images", shape))
    coefficient = symmetric("coefficient", features.shape, 1.0).double()
    (coefficient * features).sum().backward()
    file["training.features"] = picked(features, 256)
    for name, parameter in model.named_parameters():
        file[f"gradient.{name}"] = picked(parameter.grad, 48)
    optimiser.step()
    for name, tensor in tensors.items():
        file[f"after.{name}"] = picked(tensor, 48)
    model.eval()
    file["evaluation.features"] = picked(model(images("evaluation.images", shape)), 256)
    path = os.path.join(folder, f"{kind}_{channels}.safetensors")
    save_file(file, path, metadata={"torch": torch.__version__,
                                    "torchvision": torchvision.__version__,
                                    "height": str(height), "width": str(width)})
    print(path, os.path.getsize(path), "bytes", len(file), "arrays")


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    torch.set_num_threads(1)
    for kind, cases in CASES.items():
        for channels, height, width in cases:
            run(kind, channels, height, width, sys.argv[1])


main()
