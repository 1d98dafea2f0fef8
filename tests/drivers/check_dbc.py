"""Reads our .dbc files with a reader of others, and codes the vendors' own examples with them."""
import pathlib
import struct
import subprocess
import sys
import tempfile

try:
    import canmatrix.formats
except ImportError:
    print("check_dbc: found no canmatrix, wanted the package python3-canmatrix: not tested")
    sys.exit(77)


def load(program, protocol):
    text = subprocess.run([program, "base", "--protocol", protocol, "--dbc"], check=True, capture_output=True).stdout
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / f"{protocol}.dbc"
        file.write_bytes(text)
        return canmatrix.formats.loadp_flat(str(file))


def values(table, identifier, data):
    frame = next(frame for frame in table.frames if frame.arbitration_id.id == identifier)
    return {name: float(signal.phys_value) for name, signal in frame.decode(bytes(data)).items()}


def expect(found, wanted, what):
    for name, value in wanted.items():
        if abs(found[name] - value) > 1e-6:
            sys.exit(f"check_dbc: {what}: {name} is {found[name]}, wanted {value}")


program = sys.argv[1]
agilex = load(program, "agilex")
expect(values(agilex, 0x111, bytes.fromhex("0096000000000000")), {"ForwardSpeed": 0.15, "TurnSpeed": 0}, "0.15 m/s")
expect(values(agilex, 0x111, bytes.fromhex("0000003200000000")), {"ForwardSpeed": 0, "TurnSpeed": 0.05}, "0.05 rad/s")
expect(values(agilex, 0x311, bytes.fromhex("FFFFFFFE00000105")), {"LeftTravel": -2, "RightTravel": 261}, "odometer")
expect(values(agilex, 0x211, bytes.fromhex("010301050204 00C8")),
       {"VehicleState": 1, "ControlMode": 3, "Battery": 26.1, "FaultBits": 0x204, "Counter": 200}, "system state")
expect(values(agilex, 0x241, bytes.fromhex("B69C64FF00000000")), {"SwitchA": 2, "SwitchB": 1, "SwitchC": 3,
                                                                 "SwitchD": 2, "RightStickH": -100}, "remote")
command = next(frame for frame in agilex.frames if frame.arbitration_id.id == 0x111)
if command.cycle_time != 20:
    sys.exit(f"check_dbc: the motion command's period is {command.cycle_time} ms, wanted 20")

odrive = load(program, "odrive")
expect(values(odrive, 0x029, struct.pack("<ff", 12.5, -0.25)), {"Position": 12.5, "Velocity": -0.25}, "estimates")
expect(values(odrive, 0x00D, struct.pack("<ff", 1.5, 0)), {"Velocity": 1.5}, "velocity")
expect(values(odrive, 0x021, struct.pack("<IBBBB", 0x02000000, 8, 0, 1, 0)),
       {"AxisError": 0x02000000, "AxisState": 8, "TrajectoryDone": 1}, "heartbeat")
print(f"{len(agilex.frames)} AgileX and {len(odrive.frames)} ODrive messages read as they are meant")
