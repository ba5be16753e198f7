#!/usr/bin/env python3
"""Sends a request to buoyancyd from Python, using only the standard library and the code that lcm-gen generates:

    lcm-gen -p --ppath types lcmtypes/*.lcm
    buoyancyd --scene scenes/box.toml &
    PYTHONPATH=types client/examples/round_trip.py

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
STATES, WRENCHES = "BUOYANCY_STATES", "BUOYANCY_WRENCHES"


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

    def request(self, utime, states, lead_time=0.0):
        """Takes a list of body_state_t and returns the list of their body_wrench_t, in the same order."""
        request = buoyancy.body_states_t()
        request.utime, request.session_id, request.seq = utime, self.session_id, self.seq
        request.lead_time, request.num_bodies, request.bodies = lead_time, len(states), states
        self.seq += 1
        encoded = request.encode()
        for _ in range(1 + self.retries):
            self.publish(STATES, encoded)
            response = self.wait_for(request)
            if response is not None:
                return response.bodies
        raise TimeoutError(
            f"no response to request {request.seq} in {(1 + self.retries) * self.timeout:g} s: is buoyancyd running "
            f"on {self.address[0]}:{self.address[1]}?")

    def publish(self, channel, message):
        header = struct.pack(">II", MAGIC, self.datagrams)
        self.datagrams = (self.datagrams + 1) & 0xFFFFFFFF
        self.socket.sendto(header + channel.encode() + b"\0" + message, self.address)

    def wait_for(self, request):
        """Returns the response with the request's session and seq, or None after the timeout."""
        deadline = time.monotonic() + self.timeout
        while (left := deadline - time.monotonic()) > 0:
            self.socket.settimeout(left)
            try:
                datagram = self.socket.recv(65536)
            except TimeoutError:
                return None
            message = self.message_on(WRENCHES, datagram)
            if message is None:
                continue
            try:
                response = buoyancy.body_wrenches_t.decode(message)
            except (ValueError, struct.error):
                continue  # another message type
            if (response.session_id, response.seq) == (request.session_id, request.seq):
                return response
        return None

    @staticmethod
    def message_on(channel, datagram):
        end = datagram.find(b"\0", 8)
        if len(datagram) < 8 or struct.unpack(">I", datagram[:4])[0] != MAGIC or end < 0:
            return None
        return datagram[end + 1:] if datagram[8:end] == channel.encode() else None


def main():
    parser = argparse.ArgumentParser(description="Send one request to buoyancyd and print the force on a body.")
    parser.add_argument("--body", type=int, default=1, help="body id in the scene (default: %(default)s)")
    parser.add_argument("--height", type=float, default=0.0,
                        help="height of the body's origin in metres (default: %(default)s)")
    arguments = parser.parse_args()

    state = buoyancy.body_state_t()
    state.body_id = arguments.body
    state.position = [0.0, 0.0, arguments.height]
    state.quaternion_wxyz = [1.0, 0.0, 0.0, 0.0]
    wrench, = Client().request(utime=0, states=[state])
    print(f"status {wrench.status}, force {wrench.force[0]:.6g} {wrench.force[1]:.6g} {wrench.force[2]:.6f} N, "
          f"submerged volume {wrench.submerged_volume:.9f} m^3")


if __name__ == "__main__":
    main()
