"""A client as other makers write them, for a base on a CAN interface: vendor_client.py agilex|odrive INTERFACE DBC

It knows the protocol by the .dbc file only, read by python3-canmatrix, and the bus by the kernel's sockets; nothing of
ours. The order of its steps is that of the vendors' own clients: find out which protocol it is, ask for the version, take
the base over, drive, look at everything that the base tells, stop. Ends with 1 at the first thing that is not as such a
client wants it."""
import contextlib
import decimal
import io
import socket
import struct
import sys
import time

with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
    import canmatrix.formats

FORMAT = "=IB3x8s"
REMOTE = socket.CAN_RTR_FLAG


class Client:
    def __init__(self, interface, dbc):
        self.table = {frame.name: frame for frame in canmatrix.formats.loadp_flat(dbc).frames}
        self.names = {frame.arbitration_id.id: name for name, frame in self.table.items()}
        self.socket = socket.socket(socket.PF_CAN, socket.SOCK_RAW, socket.CAN_RAW)
        self.socket.bind((interface,))
        self.heard = []

    def send(self, identifier, data, flags=0):
        self.socket.send(struct.pack(FORMAT, identifier | flags, len(data), bytes(data).ljust(8, b"\0")))

    def say(self, name, **values):
        frame = self.table[name]
        signals = {signal.name: signal for signal in frame.signals}
        raw = {key: signals[key].phys2raw(decimal.Decimal(str(value))) for key, value in values.items()}
        raw = {key: float(value) if signals[key].is_float else value for key, value in raw.items()}
        self.send(frame.arbitration_id.id, frame.encode(raw))

    def listen(self, seconds):
        """Everything that is said within that time: (time, name, data)."""
        heard = []
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0:
            self.socket.settimeout(left)
            try:
                identifier, length, data = struct.unpack(FORMAT, self.socket.recv(16))
            except TimeoutError:
                break
            if identifier in self.names:
                heard.append((time.monotonic(), self.names[identifier], data[:length]))
        return heard

    def values(self, name, data):
        return {key: float(signal.phys_value) for key, signal in self.table[name].decode(data).items()}

    def wait(self, name, holds, seconds, what):
        """The values of the first such message for which that holds."""
        end = time.monotonic() + seconds
        seen = None
        while time.monotonic() < end:
            for _, heard, data in self.listen(0.01):
                if heard == name:
                    seen = self.values(name, data)
                    if holds(seen):
                        return seen
        sys.exit(f"vendor_client: {what}: in {seconds} s no {name} said so; the last one: {seen}")

    def drive(self, seconds, *commands):
        """Says the commands 50 times a second."""
        end = time.monotonic() + seconds
        heard = []
        while time.monotonic() < end:
            for name, values in commands:
                self.say(name, **values)
            heard += self.listen(0.02)
        return heard

    def expect_periods(self, seconds):
        """Whatever has a period in the table comes about as often; a busy machine may hold some back."""
        heard = [name for _, name, _ in self.listen(seconds)]
        for name, frame in self.table.items():
            if frame.cycle_time == 0 or "Base" not in frame.transmitters:
                continue
            wanted = 1000.0 * seconds / frame.cycle_time
            if not 0.5 * wanted - 1 <= heard.count(name) <= 1.2 * wanted + 2:
                sys.exit(f"vendor_client: {heard.count(name)} times {name} in {seconds} s, wanted about {wanted:.0f}")


def expect(holds, what):
    if not holds:
        sys.exit(f"vendor_client: {what}")


def agilex(client):
    first = {name for _, name, _ in client.listen(1.0)}
    expect({"MotionState", "RemoteState"} <= first, f"not to be known as protocol V2: only {first}")

    client.send(0x4A1, [1])
    text = b"".join(data for _, name, data in client.listen(1.0) if name == "VersionText")
    expect(len(text) == 80 and all(32 <= letter < 127 for letter in text), f"a version of {text!r}, wanted 80 letters")
    client.send(0x411, [1])
    client.wait("Version", lambda said: said["ControllerSoftware"] > 0, 1.0, "version in numbers")

    client.drive(0.3, ("MotionCommand", {"ForwardSpeed": 0.3}))
    client.wait("MotionState", lambda said: said["ForwardSpeed"] == 0, 0.5, "stands while nobody asked for CAN mode")
    client.send(0x421, [1, 0, 0, 0, 0, 0, 0, 0])  # eight bytes, as the vendor's client
    client.wait("SystemState", lambda said: said["ControlMode"] == 1 and said["VehicleState"] == 0, 1.0, "CAN mode")

    client.say("LightCommand", ByCommand=1, FrontMode=3, FrontBrightness=40, RearMode=1)
    client.wait("LightState", lambda said: said["FrontMode"] == 3 and said["FrontBrightness"] == 40, 1.0, "lights")

    before = client.wait("Odometer", lambda said: True, 1.0, "odometer")
    client.drive(2.0, ("MotionCommand", {"ForwardSpeed": 0.3, "TurnSpeed": 0}))
    client.wait("MotionState", lambda said: abs(said["ForwardSpeed"] - 0.3) < 0.05, 0.5, "drives ahead")
    client.say("MotionCommand", ForwardSpeed=0.3)
    client.wait("Motor1HighSpeed", lambda said: said["Speed"] > 0, 0.3, "its motor turns")
    client.wait("MotionState", lambda said: abs(said["ForwardSpeed"]) < 0.01, 3.0, "stands when nobody commands")
    after = client.wait("Odometer", lambda said: True, 1.0, "odometer")
    for wheel in ("LeftTravel", "RightTravel"):
        expect(400 < after[wheel] - before[wheel] < 1500, f"{wheel} {before[wheel]} to {after[wheel]} mm")

    client.drive(1.5, ("MotionCommand", {"ForwardSpeed": 0, "TurnSpeed": -0.5}))
    client.wait("MotionState", lambda said: abs(said["TurnSpeed"] + 0.5) < 0.1, 0.3, "turns to the right")
    client.send(0x441, [0])
    client.wait("SystemState", lambda said: said["FaultBits"] == 0, 0.5, "faults cleared")
    client.expect_periods(3.0)


def odrive(client):
    axes = ("Axis0_", "Axis1_")
    for axis in axes:
        client.say(axis + "ClearErrors", Identify=0)
        client.say(axis + "SetAxisState", RequestedState=8)  # before the controller mode, as some clients do
        client.say(axis + "SetControllerMode", ControlMode=2, InputMode=1)
    for axis in axes:
        client.wait(axis + "Heartbeat", lambda said: said["AxisState"] == 8 and said["ProcedureResult"] == 0
                    and said["AxisError"] == 0, 1.0, "closed loop")

    told = {name for _, name, _ in client.listen(0.5)}
    for kind in ("Heartbeat", "EncoderEstimates", "Error", "Currents", "Temperatures", "BusVoltageCurrent", "Torques"):
        expect(all(axis + kind in told for axis in axes), f"{kind} does not come by itself; what does: {sorted(told)}")

    client.drive(1.0, *((axis + "SetInputVelocity", {"Velocity": sign}) for axis, sign in zip(axes, (1.0, -1.0))))
    for axis, sign in zip(axes, (1.0, -1.0)):
        client.wait(axis + "EncoderEstimates", lambda said: abs(said["Velocity"] - sign) < 0.1, 0.5, "turns as told")

    for axis, node in zip(axes, (0, 1)):
        client.send(0x7E6, b"", REMOTE)  # to all nodes: who is there
        client.wait(axis + "Address", lambda said: said["NodeId"] == node and said["SerialNumber"] > 0, 0.5, "enumeration")

    version = client.table["Axis0_Version"].arbitration_id.id
    client.send(version, b"\0" * 8, REMOTE)
    client.wait("Axis0_Version", lambda said: said["FirmwareMinor"] == 6, 0.5, "a remote request for the version")
    client.send(version, b"")
    client.wait("Axis0_Version", lambda said: said["Protocol"] == 2, 0.5, "an empty frame as a request")

    client.say("Axis0_Estop")
    client.wait("Axis0_Heartbeat", lambda said: said["AxisState"] == 1 and said["AxisError"] == 0x02000000, 0.5, "estop")
    client.wait("Axis0_Error", lambda said: said["DisarmReason"] == 0x02000000, 0.5, "its reason")
    client.say("Axis0_SetAxisState", RequestedState=8)
    client.wait("Axis0_Heartbeat", lambda said: said["AxisState"] == 1, 0.5, "does not arm before errors are cleared")
    for axis in axes:
        client.say(axis + "SetInputVelocity", Velocity=0)
        client.say(axis + "ClearErrors", Identify=0)
        client.say(axis + "SetAxisState", RequestedState=8)
        client.wait(axis + "Heartbeat", lambda said: said["AxisState"] == 8, 0.5, "arms again")
    client.expect_periods(3.0)


protocol, interface, dbc = sys.argv[1:]
{"agilex": agilex, "odrive": odrive}[protocol](Client(interface, dbc))
print(f"vendor_client: {protocol}: everything is as a client wants it")
