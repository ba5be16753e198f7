#!/usr/bin/env python3
"""Publishes the surface of a sea that an FFT makes, as in J. Tessendorf's "Simulating Ocean Water", for a service whose
scene says waves = "grid". The patch repeats in both directions.

    lcm-gen -p --ppath types lcmtypes/*.lcm
    PYTHONPATH=types /usr/bin/python3 client/examples/python/publish_fft_sea.py

Needs numpy. Your simulator publishes the grid of a step before the request of the step.
"""
import argparse
import random
import socket
import struct
import time

import numpy as np

import buoyancy  # the code that lcm-gen generates

CHANNEL = b"BUOYANCY_SEA_GRID"
GRAVITY = 9.80665
RATE = 60  # Hz


class FftSea:
    """A square patch of deep water under a wind along e1."""

    def __init__(self, samples=64, length=20.0, significant_wave_height=0.4, wind_speed=6.0, seed=1):
        self.spacing = length / samples
        k = 2 * np.pi * np.fft.fftfreq(samples, self.spacing)
        k1, k2 = np.meshgrid(k, k)  # columns along e1, rows along e2
        norm = np.hypot(k1, k2)
        norm[0, 0] = 1.0
        longest = wind_speed**2 / GRAVITY
        phillips = np.exp(-1 / (norm * longest) ** 2) / norm**4 * (k1 / norm) ** 2
        phillips[k1 <= 0] = 0.0  # no wave runs against the wind
        normal = np.random.default_rng(seed).normal(size=(2, samples, samples))
        self.amplitudes = np.sqrt(phillips) * (normal[0] + 1j * normal[1])
        self.frequencies = np.sqrt(GRAVITY * norm)
        self.amplitudes *= significant_wave_height / 4 / np.std(self.elevation(0.0))

    def elevation(self, t):
        """[m] at t seconds, (rows, columns)."""
        return np.fft.ifft2(self.amplitudes * np.exp(-1j * self.frequencies * t)).real


def message_of(sea, utime, instance_id):
    grid = buoyancy.sea_grid_t()
    grid.utime, grid.instance_id, grid.level, grid.periodic = utime, instance_id, 0.0, 1
    grid.origin, grid.spacing = [0.0, 0.0], [sea.spacing, sea.spacing]
    grid.elevation = sea.elevation(utime / 1e6)
    grid.rows, grid.columns = grid.elevation.shape
    return grid.encode()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("steps", type=int, nargs="?", default=RATE * 3600, help="number of grids (%(default)s)")
    parser.add_argument("--ttl", type=int, default=0, help="1: also to other machines of the network")
    arguments = parser.parse_args()
    sea, instance_id = FftSea(), random.getrandbits(63)
    sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    sender.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, arguments.ttl)
    for step in range(arguments.steps):
        message = message_of(sea, round(1e6 * step / RATE), instance_id)
        # LCM's format of a message of at most 65,499 bytes; its Python module also sends larger ones.
        datagram = struct.pack(">4sI", b"LC02", step) + CHANNEL + b"\0" + message
        sender.sendto(datagram, ("239.255.76.67", 7667))
        time.sleep(1 / RATE)


if __name__ == "__main__":
    main()
