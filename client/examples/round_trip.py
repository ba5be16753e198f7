#!/usr/bin/env python3
"""Sends a request to buoyancyd from Python, using only the standard library and the code that lcm-gen generates:

    lcm-gen -p --ppath types lcmtypes/*.lcm
    buoyancyd --scene scenes/box.toml &
    PYTHONPATH=types client/examples/round_trip.py

With a scene that requests loads, such as scenes/crate.toml, `--loads --velocity 0 0 -0.5` prints drag and added mass too.
Where LCM's own Python module is installed, it does the same in fewer lines. This example shows the wire format: a
datagram holds "LC02", a sequence number, the channel, a zero byte, and the message. Messages of more than 65,499 bytes
are split into several datagrams ("LC03"); the messages of this client are always smaller.
"""
import argparse
import random
import socket
import struct
import time

import buoyancy

MAGIC = 0x4C433032  # "LC02"
STATES, WRENCHES, LOADS = "BUOYANCY_STATES", "BUOYANCY_WRENCHES", "BUOYANCY_LOADS"


class Client:
    """One session in lock-step: a request is resent until its response arrives."""

    def __init__(self, group="239.255.76.67", port=7667, ttl=0, timeout=0.1, retries=50):
        self.address = (group, port)
        self.timeout, self.retries = timeout, retries
        self.session_id = random.getrandbits(63)
        self.seq = 0
        self.datagrams = 0
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEPORT, 1)
        self.socket.bind(("", port))
        member = struct.pack("4s4s", socket.inet_aton(group), socket.inet_aton("0.0.0.0"))
        self.socket.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, member)
        self.socket.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, ttl)

    def request(self, utime, states, lead_time=0.0, loads=False):
        """Takes a list of body_state_t. Returns the list of their body_wrench_t, in the same order, and with loads=True
        the list of the body_loads_t of those bodies that have this output."""
        request = buoyancy.body_states_t()
        request.utime, request.session_id, request.seq = utime, self.session_id, self.seq
        request.lead_time, request.num_bodies, request.bodies = lead_time, len(states), states
        self.seq += 1
        encoded = request.encode()
        expected = {WRENCHES: buoyancy.body_wrenches_t}
        if loads:
            expected[LOADS] = buoyancy.bodies_loads_t
        for _ in range(1 + self.retries):
            self.publish(STATES, encoded)
            received = self.wait_for(request, expected)
            if received is not None:
                return [received[channel].bodies for channel in expected] if loads else received[WRENCHES].bodies
        raise TimeoutError(
            f"no response to request {request.seq} in {(1 + self.retries) * self.timeout:g} s: is buoyancyd running "
            f"on {self.address[0]}:{self.address[1]}" + (", and does its scene request loads?" if loads else "?"))

    def publish(self, channel, message):
        header = struct.pack(">II", MAGIC, self.datagrams)
        self.datagrams = (self.datagrams + 1) & 0xFFFFFFFF
        self.socket.sendto(header + channel.encode() + b"\0" + message, self.address)

    def wait_for(self, request, expected):
        """Returns the messages with the request's session and seq by channel, or None after the timeout. expected: their
        types by channel."""
        received = {}
        deadline = time.monotonic() + self.timeout
        while (left := deadline - time.monotonic()) > 0:
            self.socket.settimeout(left)
            try:
                datagram = self.socket.recv(65536)
            except TimeoutError:
                return None
            channel, message = self.split(datagram)
            if channel not in expected:
                continue
            try:
                response = expected[channel].decode(message)
            except (ValueError, struct.error):
                continue  # another message type
            if (response.session_id, response.seq) == (request.session_id, request.seq):
                received[channel] = response
                if len(received) == len(expected):
                    return received
        return None

    @staticmethod
    def split(datagram):
        """Returns a message and the name of its channel, which is empty if this is no message in one datagram."""
        end = datagram.find(b"\0", 8)
        if len(datagram) < 8 or struct.unpack(">I", datagram[:4])[0] != MAGIC or end < 0:
            return "", b""
        return datagram[8:end].decode(errors="replace"), datagram[end + 1:]


def main():
    parser = argparse.ArgumentParser(description="Send one request to buoyancyd and print the force on a body.")
    parser.add_argument("--body", type=int, default=1, help="body id in the scene (default: %(default)s)")
    parser.add_argument("--height", type=float, default=0.0,
                        help="height of the body's origin in metres (default: %(default)s)")
    parser.add_argument("--velocity", type=float, nargs=3, default=[0.0, 0.0, 0.0], metavar=("VX", "VY", "VZ"),
                        help="velocity of the body's origin in m/s, which drag depends on (default: 0 0 0)")
    parser.add_argument("--retries", type=int, default=50,
                        help="how often a request is sent again, every 0.1 s (default: %(default)s)")
    parser.add_argument("--loads", action="store_true", help="print the body's drag and added mass in heave too")
    arguments = parser.parse_args()

    state = buoyancy.body_state_t()
    state.body_id = arguments.body
    state.position = [0.0, 0.0, arguments.height]
    state.quaternion_wxyz = [1.0, 0.0, 0.0, 0.0]
    state.linear_velocity = arguments.velocity
    client = Client(retries=arguments.retries)
    if arguments.loads:
        (wrench,), (loads,) = client.request(utime=0, states=[state], loads=True)
    else:
        wrench, = client.request(utime=0, states=[state])
    print(f"status {wrench.status}, force {wrench.force[0]:.6g} {wrench.force[1]:.6g} {wrench.force[2]:.6f} N, "
          f"submerged volume {wrench.submerged_volume:.9f} m^3")
    if arguments.loads:
        print(f"immersion {loads.immersion:.6f}, drag in heave {loads.drag_force[2]:.6f} N, "
              f"added mass in heave {loads.added_mass[2][2]:.6f} kg")


if __name__ == "__main__":
    main()
