# SPDX-License-Identifier: Apache-2.0
"""Loads a dataset of `shoal replay export` with Minari and holds it to what Minari itself writes.

usage: minari_dataset.py FOLDER

FOLDER has main_data.hdf5 and metadata.json. Every episode must be read with one observation more
than steps, each within the spaces of the metadata, and have ended at its last step and no other.
Then Minari writes the same episodes into a dataset of its own, and the two files are compared:
names, shapes, types, values. Prints a line and exits with 1 where anything differs. Wants
minari[hdf5] and pillow from PyPI; nothing of Shoal needs Python. For example:

  shoal replay export reach-kept --output dataset/main_data.hdf5
  minari_dataset.py dataset
"""

import sys
import tempfile

import h5py
import minari
import numpy as np
from minari.data_collector.episode_buffer import EpisodeBuffer
from minari.dataset.minari_storage import MinariStorage

# Which episode of the run it is: ours to add.
OWN_ATTRIBUTES = {"env", "episode"}


def check_episodes(dataset):
    steps = 0
    for episode in dataset.iterate_episodes():
        length = len(episode)
        steps += length
        assert dataset.action_space.contains(episode.actions[0]), episode.id
        for name, values in episode.observations.items():
            space = dataset.observation_space[name]
            assert len(values) == length + 1, (episode.id, name)
            assert all(space.contains(value) for value in values), (episode.id, name)
        ended = episode.terminations | episode.truncations
        assert ended[-1] and not ended[:-1].any(), episode.id
        for name, values in episode.infos.items():
            assert len(values) == length + 1, (episode.id, name)
    assert steps == dataset.total_steps, (steps, dataset.total_steps)


def written_by_minari(dataset, folder):
    storage = MinariStorage.new(folder, dataset.observation_space, dataset.action_space,
                                jpeg_encoding=False)
    for episode in dataset.iterate_episodes():
        storage.update_episodes([EpisodeBuffer(
            id=None, seed=None, options=None, observations=episode.observations,
            actions=episode.actions, rewards=episode.rewards, terminations=episode.terminations,
            truncations=episode.truncations, infos=episode.infos)])
    return h5py.File(f"{folder}/main_data.hdf5")


def contents(file):
    """{name: array or attribute} of everything in a file."""
    found = {}

    def take(name, node):
        if isinstance(node, h5py.Dataset):
            found[name] = node[()]
        found.update({f"{name}@{key}": np.int64(value) for key, value in node.attrs.items()
                      if key not in OWN_ATTRIBUTES})

    file.visititems(take)
    return found


def differences(ours, theirs):
    for name in sorted(ours.keys() | theirs.keys()):
        if name not in ours or name not in theirs:
            yield f"{name}: only in {'ours' if name in ours else 'theirs'}"
        elif ours[name].dtype != theirs[name].dtype or not np.array_equal(ours[name], theirs[name]):
            yield f"{name}: {ours[name].dtype} {ours[name].shape} differs from " \
                  f"{theirs[name].dtype} {theirs[name].shape}"


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    dataset = minari.MinariDataset(sys.argv[1])
    check_episodes(dataset)
    with tempfile.TemporaryDirectory() as folder:
        theirs = contents(written_by_minari(dataset, folder))
        ours = contents(h5py.File(f"{sys.argv[1]}/main_data.hdf5"))
        found = list(differences(ours, theirs))
    print(f"{dataset.spec.dataset_id}: {dataset.total_episodes} episodes, {dataset.total_steps} "
          f"steps, {len(ours)} arrays and attributes, {len(found)} differ from Minari's own")
    if found:
        sys.exit("\n".join(found[:10]))


if __name__ == "__main__":
    main()
