"""Start the real buoyancyd in a test, on an address of its own, and stop it.

With pytest, put this into conftest.py:

    pytest_plugins = ["buoyancy.testing"]

and ask for the fixture in a test:

    def test_crate_floats(buoyancy_service):
        service = buoyancy_service("scenes/box.toml")
        client = buoyancy.Client(lcm_url=service.lcm_url)

Every service that a test starts is stopped at its end, and pytest shows its log if the test failed. Without
pytest, Service is a context manager:

    with Service("scenes/box.toml", arguments=["--inject", "drop=0.1"]) as service:
        run_my_simulator(environment={"LCM_DEFAULT_URL": service.lcm_url})

buoyancyd is searched for in $PATH; the environment variable BUOYANCYD names another one. Neither root nor a
multicast route is needed: where the machine has no multicast, the process moves into a network of its own
(enter_private_network).
"""

from __future__ import annotations

import ctypes
import errno
import fcntl
import os
import pathlib
import random
import signal
import socket
import struct
import subprocess
import tempfile
import threading
import time
from collections.abc import Iterable

__all__ = ["Service", "ServiceError", "buoyancy_service", "ensure_multicast", "enter_private_network", "has_multicast"]

_GROUP = "239.255.76.67"
_PORTS = range(20000, 30000)  # below the ports that the kernel gives to senders
_LIBC = ctypes.CDLL(None, use_errno=True)
_STOP_TIMEOUT = 10.0  # [s]
_POLL_INTERVAL = 0.002  # [s]


class ServiceError(RuntimeError):
    """buoyancyd cannot be started; the text has the reason, and its log."""


def has_multicast() -> bool:
    """Return whether a packet over UDP multicast comes back on this machine.

    It takes a route, which a container or a machine without a network may lack.
    """
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as receiver, socket.socket(
        socket.AF_INET, socket.SOCK_DGRAM
    ) as sender:
        try:
            receiver.bind(("", 0))
            membership = struct.pack("4s4s", socket.inet_aton(_GROUP), socket.inet_aton("0.0.0.0"))
            receiver.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, membership)
            receiver.settimeout(2.0)
            sender.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 0)
            sender.sendto(b"buoyancy", (_GROUP, receiver.getsockname()[1]))
            return receiver.recv(64) == b"buoyancy"
        except OSError:  # no route, or no packet in time
            return False


def enter_private_network() -> None:
    """Move this process into a network namespace of its own, with a multicast route on its loopback.

    Processes that it starts from then on are there too. Everything else is out of reach: the internet, and
    services on this machine. Without root, the process also gets a user namespace, in which it is root; the
    kernel then requires that it has one thread only, so call this before a library starts threads.

    Raises ServiceError if the machine does not permit it.
    """
    clone_newuser, clone_newnet = 0x10000000, 0x40000000
    user, group = os.geteuid(), os.getegid()
    if _LIBC.unshare(clone_newnet if user == 0 else clone_newuser | clone_newnet) != 0:
        code = ctypes.get_errno()
        if code == errno.EINVAL:
            raise ServiceError(
                "a private network for tests: this process has several threads; expected one. Likely cause: a library "
                "has started them. Call buoyancy.testing.enter_private_network() before it is imported, or run the "
                "tests within: unshare --user --map-root-user --net"
            )
        raise ServiceError(
            f"a private network for tests: unshare: {os.strerror(code)}; expected a kernel that permits network "
            "namespaces. Likely cause: a container without the capability SYS_ADMIN. Give the machine a multicast "
            "route instead, as root: ip link set lo up && ip route add 224.0.0.0/4 dev lo"
        )
    if user != 0:
        for name, text in (("setgroups", "deny"), ("uid_map", f"0 {user} 1"), ("gid_map", f"0 {group} 1")):
            pathlib.Path("/proc/self", name).write_text(text)
    _set_up_loopback()


def _set_up_loopback() -> None:
    """Do what `ip link set lo up && ip route add 224.0.0.0/4 dev lo` does, without the package iproute2."""
    get_flags, set_flags, add_route, up = 0x8913, 0x8914, 0x890B, 0x1
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as control:
        interface = bytearray(struct.pack("16sh22x", b"lo", 0))
        fcntl.ioctl(control, get_flags, interface)
        (flags,) = struct.unpack_from("h", interface, 16)
        struct.pack_into("h", interface, 16, flags | up)
        fcntl.ioctl(control, set_flags, interface)
        device = ctypes.create_string_buffer(b"lo")

        def address(text):
            return struct.pack("=HH4s8x", socket.AF_INET, 0, socket.inet_aton(text))

        # struct rtentry: padding, destination, gateway, mask, flags, ..., device at its place.
        route = struct.pack(
            "@L16s16s16sHhLPhPLLH",
            0, address("224.0.0.0"), address("0.0.0.0"), address("240.0.0.0"), up, 0, 0, 0, 0,
            ctypes.addressof(device), 0, 0, 0,
        )
        fcntl.ioctl(control, add_route, route)


def ensure_multicast() -> None:
    """Do nothing if has_multicast(), else enter_private_network()."""
    if not has_multicast():
        enter_private_network()


def _take_port() -> tuple[int, socket.socket]:
    """Return a port that no other test on this machine has, and the socket that reserves it.

    The reservation is an abstract socket, which the kernel removes with its owner.
    """
    for _ in range(1000):
        number = random.SystemRandom().choice(_PORTS)
        lock = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        try:
            lock.bind(f"\0buoyancy-testing-{number}")
            with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
                probe.bind(("", number))
            return number, lock
        except OSError:
            lock.close()
    raise ServiceError("a port for buoyancyd: 1,000 ports are in use; expected a free one from 20000 to 29999")


class Service:
    """A running buoyancyd, on an address that no other service of a test on this machine has.

    Args:
        scene: path of a scene file.
        scene_text: its text, in place of a file; paths of meshes in it are absolute.
        arguments: more of buoyancyd's, such as ["--inject", "drop=0.1"].
        program: None for $BUOYANCYD, else buoyancyd in $PATH.
        ready_timeout: [s]; large meshes take time to load.

    Raises ServiceError if the service ends or is not ready in time, with its log.
    """

    def __init__(
        self,
        scene: str | os.PathLike[str] | None = None,
        *,
        scene_text: str | None = None,
        arguments: Iterable[str | os.PathLike[str]] = (),
        program: str | os.PathLike[str] | None = None,
        ready_timeout: float = 60.0,
    ) -> None:
        self._process = None
        self._folder = None
        if (scene is None) == (scene_text is None):
            raise ValueError("buoyancyd for a test: expected one of scene and scene_text")
        ensure_multicast()
        if scene_text is not None:
            self._folder = tempfile.TemporaryDirectory(prefix="buoyancy-testing-")
            scene = pathlib.Path(self._folder.name, "scene.toml")
            scene.write_text(scene_text, encoding="utf-8")
        port, self._lock = _take_port()
        #: The address, for a client and for $LCM_DEFAULT_URL of a simulator. Its packets stay on this machine.
        self.lcm_url = f"udpm://{_GROUP}:{port}?ttl=0"
        program = os.fspath(program or os.environ.get("BUOYANCYD") or "buoyancyd")
        self._log = tempfile.TemporaryFile()
        command = [program, "--scene", os.fspath(scene), "--lcm-url", self.lcm_url, *map(os.fspath, arguments)]
        error = self._start(command)
        if error is not None:
            self.stop()
            raise ServiceError(
                f"{program}: {error.strerror}; expected the program. Install the package buoyancy, or set $BUOYANCYD"
            ) from error
        if not self.wait_for_log("ready:", ready_timeout):
            code = self._process.poll()
            log = self.log
            self.stop()
            actual = f"not ready after {ready_timeout} s" if code is None else f"exit code {code}"
            raise ServiceError(f"{program}: {actual}; expected a service that is ready. Its log:\n{log}")

    def _start(self, command: list[str]) -> OSError | None:
        """Start the program in a thread that lives as long: the kernel ends the program when that thread ends."""
        started = threading.Event()
        errors: list[OSError] = []

        def parent() -> None:
            try:
                self._process = subprocess.Popen(
                    command,
                    stdin=subprocess.DEVNULL,
                    stdout=self._log,
                    stderr=self._log,
                    preexec_fn=_end_with_parent,
                )
            except OSError as error:
                errors.append(error)
            started.set()
            if not errors:
                self._process.wait()

        threading.Thread(target=parent, name="buoyancyd's parent", daemon=True).start()
        started.wait()
        return errors[0] if errors else None

    @property
    def log(self) -> str:
        """The log of the service, so far."""
        text = b""
        while chunk := os.pread(self._log.fileno(), 1 << 16, len(text)):
            text += chunk
        return text.decode(errors="replace")

    @property
    def pid(self) -> int:
        """The process id, also after the service has ended."""
        return self._process.pid

    @property
    def is_running(self) -> bool:
        """Whether the service has not ended."""
        return self._process.poll() is None

    def wait_for_log(self, text: str, timeout: float) -> bool:
        """Wait until the log contains the text.

        Returns False if it does not within `timeout` [s], or if the service ends before.
        """
        end = time.monotonic() + timeout
        while True:
            ended = not self.is_running  # checked before the log is read, which is complete then
            if text in self.log:
                return True
            if ended or time.monotonic() >= end:
                return False
            time.sleep(_POLL_INTERVAL)

    def stop(self) -> int | None:
        """End the service with SIGTERM, or with SIGKILL if that takes longer than 10 s; return its exit code.

        A second call returns the same.
        """
        code = None
        if self._process is not None:
            if self.is_running:
                self._process.send_signal(signal.SIGTERM)
            try:
                code = self._process.wait(_STOP_TIMEOUT)
            except subprocess.TimeoutExpired:
                self._process.kill()
                code = self._process.wait()
        if self._folder is not None:
            self._folder.cleanup()
            self._folder = None
        self._lock.close()
        return code

    def __enter__(self) -> Service:
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()


def _end_with_parent() -> None:
    """In the child, before it becomes buoyancyd: end when the test's process ends, however it does."""
    pr_set_pdeathsig = 1
    _LIBC.prctl(pr_set_pdeathsig, signal.SIGKILL)


try:
    import pytest
except ImportError:  # Service works without it
    pass
else:

    def pytest_configure() -> None:
        """Call ensure_multicast() before tests import libraries that start threads, such as numpy."""
        try:
            ensure_multicast()
        except ServiceError:
            pass  # the first service that a test starts reports it

    @pytest.hookimpl(hookwrapper=True)
    def pytest_runtest_makereport(item, call):
        """Append the logs of the services that a failed test started to its report."""
        outcome = yield
        report = outcome.get_result()
        if report.failed:
            for service in getattr(item, "_buoyancy_services", ()):
                report.sections.append(("The log of buoyancyd", service.log))

    @pytest.fixture
    def buoyancy_service(request):
        """A function that starts a service: its arguments are those of Service."""
        services = request.node._buoyancy_services = []

        def start(scene=None, **options):
            services.append(Service(scene, **options))
            return services[-1]

        yield start
        codes = [service.stop() for service in services]
        assert not any(codes), f"buoyancyd ended with exit code {codes}"
