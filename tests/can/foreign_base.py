"""A differential base as another maker builds it: foreign_base.py INTERFACE [QUIRK]...

It speaks AgileX's protocol V2 as a TRACER's manual describes it, and was written from that description alone: Python's
standard library and the kernel's sockets, nothing of ours. Its quirks are those of real bases (--help). At SIGTERM it
prints where it truly is and how far it drove.

The simulated camera asks the world under the interface's name where the robot is; so this world answers, on the abstract
socket lodestar-world-INTERFACE: (nanoseconds, x, y, yaw) in each message."""
import argparse
import collections
import math
import random
import signal
import socket
import struct
import sys
import time

FRAME = struct.Struct("=IB3x8s")
POSE = struct.Struct("=qddd")
TRACK_M = 0.40
MAX_WHEEL_MPS = 1.5
ACCELERATION_MPS2 = 1.8
LAG_S = 0.06
COMMAND_TIMEOUT_S = 0.5
STANDBY, CAN_MODE, REMOTE = 0, 1, 3


def arguments():
    parser = argparse.ArgumentParser()
    parser.add_argument("interface")
    parser.add_argument("--start", default="1.2,5.6,0", help="true pose at the start: metres and degrees")
    parser.add_argument("--grants-can-after", type=float, default=0.0, help="seconds from the first request for CAN mode")
    parser.add_argument("--remote-first", type=float, default=0.0, help="seconds for which the remote control drives")
    parser.add_argument("--noise-at-rest", type=float, default=0.0, help="of the measured speeds, m/s and rad/s, always")
    parser.add_argument("--state-period", type=float, default=0.02, help="seconds between two system states")
    parser.add_argument("--counter-values", type=int, default=256, help="after which the state's counter begins again")
    parser.add_argument("--right-wheel", type=float, default=1.0, help="its true size over the nominal one")
    parser.add_argument("--dead-time", type=float, default=0.0, help="seconds from a command to its effect")
    parser.add_argument("--fault-bits", type=lambda text: int(text, 16), default=0, help="of bytes 4 and 5, as reported")
    parser.add_argument("--fault-stays", action="store_true", help="when it is told to clear it")
    parser.add_argument("--no-odometer", action="store_true")
    parser.add_argument("--seed", type=int, default=1)
    return parser.parse_args()


class Wheels:
    """Two wheels with a speed loop, the ground under them, and encoders that know nothing of their true size."""

    def __init__(self, start, right_scale):
        self.x_m, self.y_m, self.yaw_rad = start
        self.right_scale = right_scale
        self.speeds_mps = [0.0, 0.0]
        self.rolled_m = [0.0, 0.0]
        self.driven_m = 0.0

    def step(self, forward_mps, turn_radps, elapsed_s):
        ground_m = []
        for i, sign in enumerate((-1, 1)):
            target = max(-MAX_WHEEL_MPS, min(MAX_WHEEL_MPS, forward_mps + sign * turn_radps * TRACK_M / 2))
            rate = (target - self.speeds_mps[i]) / max(LAG_S, elapsed_s)
            rate = max(-ACCELERATION_MPS2, min(ACCELERATION_MPS2, rate))
            before = self.speeds_mps[i]
            self.speeds_mps[i] += rate * elapsed_s
            if target == 0 and abs(self.speeds_mps[i]) < 1e-4:
                self.speeds_mps[i] = 0.0
            rolled = (before + self.speeds_mps[i]) / 2 * elapsed_s
            self.rolled_m[i] += rolled
            ground_m.append(rolled * (self.right_scale if i == 1 else 1.0))
        forward_m, turn_rad = sum(ground_m) / 2, (ground_m[1] - ground_m[0]) / TRACK_M
        middle_rad = self.yaw_rad + turn_rad / 2
        self.x_m += forward_m * math.cos(middle_rad)
        self.y_m += forward_m * math.sin(middle_rad)
        self.yaw_rad += turn_rad
        self.driven_m += abs(forward_m)

    def measured(self):
        left, right = self.speeds_mps
        return (left + right) / 2, (right - left) / TRACK_M


class World:
    """Tells the camera where the robot is."""

    def __init__(self, interface):
        self.listening = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET | socket.SOCK_NONBLOCK)
        self.listening.bind("\0lodestar-world-" + interface)
        self.listening.listen(8)
        self.cameras = []

    def tell(self, wheels, now_s):
        try:
            while True:
                camera, _ = self.listening.accept()
                camera.setblocking(False)
                self.cameras.append(camera)
        except BlockingIOError:
            pass
        pose = POSE.pack(int(now_s * 1e9), wheels.x_m, wheels.y_m, wheels.yaw_rad)
        for camera in list(self.cameras):
            try:
                camera.send(pose)
            except BlockingIOError:
                pass
            except OSError:
                self.cameras.remove(camera)


class Base:
    """The controller: what it hears and says on the bus."""

    def __init__(self, quirks, wheels):
        self.quirks, self.wheels = quirks, wheels
        self.random = random.Random(quirks.seed)
        self.can = socket.socket(socket.PF_CAN, socket.SOCK_RAW, socket.CAN_RAW)
        self.can.bind((quirks.interface,))
        self.can.setblocking(False)
        self.began_s = time.monotonic()
        self.mode = REMOTE if quirks.remote_first > 0 else STANDBY
        self.fault_bits = quirks.fault_bits
        self.counter = 0
        self.first_request_s = None
        self.commands = collections.deque()  # (time, forward, turn), those that have no effect yet
        self.command = (-math.inf, 0.0, 0.0)

    def hear(self, now_s):
        if self.mode == REMOTE and now_s - self.began_s > self.quirks.remote_first:
            self.mode = STANDBY
        try:
            while True:
                identifier, length, data = FRAME.unpack(self.can.recv(16))
                self.handle(identifier, data[:length], now_s)
        except BlockingIOError:
            pass

    def handle(self, identifier, data, now_s):
        if identifier == 0x111 and len(data) == 8:
            forward, turn = struct.unpack(">hh", data[:4])
            if self.mode == CAN_MODE:
                self.commands.append((now_s, forward / 1000, turn / 1000))
        elif identifier == 0x421 and len(data) >= 1:
            self.first_request_s = self.first_request_s or now_s
            is_late = now_s - self.first_request_s < self.quirks.grants_can_after
            if self.mode != REMOTE and not is_late and data[0] in (STANDBY, CAN_MODE):
                self.mode = data[0]
        elif identifier == 0x441 and len(data) >= 1 and data[0] == 0 and not self.quirks.fault_stays:
            self.fault_bits = 0

    def wanted(self, now_s):
        while self.commands and now_s - self.commands[0][0] >= self.quirks.dead_time:
            self.command = self.commands.popleft()
        is_valid = now_s - self.command[0] - self.quirks.dead_time <= COMMAND_TIMEOUT_S and self.mode == CAN_MODE
        return self.command[1:] if is_valid else (0.0, 0.0)

    def say(self, identifier, data):
        try:
            self.can.send(FRAME.pack(identifier, len(data), data.ljust(8, b"\0")))
        except OSError:
            pass  # the bus takes none now: the next one is newer

    def say_state(self):
        battery = 258
        self.say(0x211, struct.pack(">BBHHBB", 0, self.mode, battery, self.fault_bits, 0, self.counter))
        self.counter = (self.counter + 1) % self.quirks.counter_values

    def say_motion(self):
        noise = [self.random.gauss(0, self.quirks.noise_at_rest) for _ in range(2)]
        measured = (max(-32768, min(32767, int(1000 * (speed + wrong))))
                    for speed, wrong in zip(self.wheels.measured(), noise))
        self.say(0x221, struct.pack(">hhhh", *measured, 0, 0))
        if not self.quirks.no_odometer:
            self.say(0x311, struct.pack(">ii", *(int(1000 * rolled) for rolled in self.wheels.rolled_m)))


class Due:
    """True once a period; what was missed is not made up for."""

    def __init__(self, period_s):
        self.period_s, self.next_s = period_s, 0.0

    def __call__(self, now_s):
        if now_s < self.next_s:
            return False
        self.next_s = max(self.next_s + self.period_s, now_s)
        return True


def main():
    quirks = arguments()
    x_m, y_m, yaw_deg = (float(number) for number in quirks.start.split(","))
    wheels = Wheels((x_m, y_m, math.radians(yaw_deg)), quirks.right_wheel)
    base, world = Base(quirks, wheels), World(quirks.interface)
    ended = []
    signal.signal(signal.SIGTERM, lambda *_: ended.append(True))
    state_is_due, motion_is_due = Due(quirks.state_period), Due(0.02)
    then_s = time.monotonic()
    while not ended:
        time.sleep(0.01)
        now_s = time.monotonic()
        base.hear(now_s)
        wheels.step(*base.wanted(now_s), min(now_s - then_s, 0.1))
        then_s = now_s
        world.tell(wheels, now_s)
        if state_is_due(now_s):
            base.say_state()
        if motion_is_due(now_s):
            base.say_motion()
    print(f"at {wheels.x_m:.4f} {wheels.y_m:.4f} {math.degrees(wheels.yaw_rad):.3f} driven {wheels.driven_m:.3f}")
    return 0


sys.exit(main())
