#pragma once

#include "drivers/base/protocol_table.hpp"

// ODrive CANSimple, firmware 0.6, as a table: identifier = node * 32 + command.
namespace lodestar::odrive {

inline constexpr std::uint32_t node_step = 32;

// Axis states.
inline constexpr std::uint8_t idle = 1;
inline constexpr std::uint8_t closed_loop_control = 8;
// Control and input modes.
inline constexpr std::uint8_t velocity_control = 2;
inline constexpr std::uint8_t passthrough = 1;

// Axis errors with a meaning beyond a fault of the axis.
inline constexpr std::uint32_t estop_requested = 0x02000000;
inline constexpr std::uint32_t watchdog_expired = 0x01000000;

namespace tables {

using enum SignalKind;
using std::chrono::milliseconds;

inline constexpr std::array heartbeat_signals{
    Signal{.name = "AxisError", .byte = 0, .bits = 32}, Signal{.name = "AxisState", .byte = 4},
    Signal{.name = "ProcedureResult", .byte = 5}, Signal{.name = "TrajectoryDone", .byte = 6, .bits = 1}};
inline constexpr std::array error_signals{Signal{.name = "ActiveErrors", .byte = 0, .bits = 32},
                                          Signal{.name = "DisarmReason", .byte = 4, .bits = 32}};
inline constexpr std::array address_signals{Signal{.name = "NodeId", .byte = 0},
                                            Signal{.name = "SerialNumber", .byte = 1, .bits = 48}};
inline constexpr std::array axis_state_signals{Signal{.name = "RequestedState", .byte = 0, .bits = 32}};
inline constexpr std::array estimate_signals{
    Signal{.name = "Position", .byte = 0, .bits = 32, .kind = float32, .unit = "rev"},
    Signal{.name = "Velocity", .byte = 4, .bits = 32, .kind = float32, .unit = "rev/s"}};
inline constexpr std::array mode_signals{Signal{.name = "ControlMode", .byte = 0, .bits = 32},
                                         Signal{.name = "InputMode", .byte = 4, .bits = 32}};
inline constexpr std::array velocity_signals{
    Signal{.name = "Velocity", .byte = 0, .bits = 32, .kind = float32, .unit = "rev/s"},
    Signal{.name = "TorqueFeedForward", .byte = 4, .bits = 32, .kind = float32, .unit = "Nm"}};
inline constexpr std::array bus_signals{
    Signal{.name = "BusVoltage", .byte = 0, .bits = 32, .kind = float32, .unit = "V"},
    Signal{.name = "BusCurrent", .byte = 4, .bits = 32, .kind = float32, .unit = "A"}};
inline constexpr std::array version_signals{
    Signal{.name = "Protocol", .byte = 0},         Signal{.name = "HardwareMajor", .byte = 1},
    Signal{.name = "HardwareMinor", .byte = 2},    Signal{.name = "HardwareVariant", .byte = 3},
    Signal{.name = "FirmwareMajor", .byte = 4},    Signal{.name = "FirmwareMinor", .byte = 5},
    Signal{.name = "FirmwareRevision", .byte = 6}, Signal{.name = "FirmwareUnreleased", .byte = 7}};
inline constexpr std::array position_signals{
    Signal{.name = "Position", .byte = 0, .bits = 32, .kind = float32, .unit = "rev"},
    Signal{.name = "VelocityFeedForward",
           .byte = 4,
           .bits = 16,
           .kind = signed_integer,
           .scale = 0.001,
           .unit = "rev/s"},
    Signal{.name = "TorqueFeedForward",
           .byte = 6,
           .bits = 16,
           .kind = signed_integer,
           .scale = 0.001,
           .unit = "Nm"}};
inline constexpr std::array torque_signals{
    Signal{.name = "Torque", .byte = 0, .bits = 32, .kind = float32, .unit = "Nm"}};
inline constexpr std::array limit_signals{
    Signal{.name = "VelocityLimit", .byte = 0, .bits = 32, .kind = float32, .unit = "rev/s"},
    Signal{.name = "CurrentLimit", .byte = 4, .bits = 32, .kind = float32, .unit = "A"}};
inline constexpr std::array current_signals{
    Signal{.name = "WantedCurrent", .byte = 0, .bits = 32, .kind = float32, .unit = "A"},
    Signal{.name = "MeasuredCurrent", .byte = 4, .bits = 32, .kind = float32, .unit = "A"}};
inline constexpr std::array temperature_signals{
    Signal{.name = "InverterTemperature", .byte = 0, .bits = 32, .kind = float32, .unit = "degC"},
    Signal{.name = "MotorTemperature", .byte = 4, .bits = 32, .kind = float32, .unit = "degC"}};
inline constexpr std::array torques_signals{
    Signal{.name = "WantedTorque", .byte = 0, .bits = 32, .kind = float32, .unit = "Nm"},
    Signal{.name = "EstimatedTorque", .byte = 4, .bits = 32, .kind = float32, .unit = "Nm"}};
inline constexpr std::array power_signals{
    Signal{.name = "ElectricalPower", .byte = 0, .bits = 32, .kind = float32, .unit = "W"},
    Signal{.name = "MechanicalPower", .byte = 4, .bits = 32, .kind = float32, .unit = "W"}};
inline constexpr std::array clear_signals{Signal{.name = "Identify", .byte = 0}};

inline constexpr MessageSpec version{.name = "Version",
                                     .id = 0x00,
                                     .sender = Sender::base,
                                     .order = ByteOrder::little_endian,
                                     .signals = version_signals};
inline constexpr MessageSpec heartbeat{.name = "Heartbeat",
                                       .id = 0x01,
                                       .sender = Sender::base,
                                       .order = ByteOrder::little_endian,
                                       .period = milliseconds(100),
                                       .timeout = milliseconds(300),
                                       .signals = heartbeat_signals};
inline constexpr MessageSpec estop{.name = "Estop",
                                   .id = 0x02,
                                   .sender = Sender::host,
                                   .length = 0,
                                   .least_length = 0,
                                   .order = ByteOrder::little_endian};
inline constexpr MessageSpec error{.name = "Error",
                                   .id = 0x03,
                                   .sender = Sender::base,
                                   .order = ByteOrder::little_endian,
                                   .period = milliseconds(100),
                                   .signals = error_signals};
/// Each axis's answer to a request to itself or to address_of_all: who is on the bus.
inline constexpr MessageSpec address{.name = "Address",
                                     .id = 0x06,
                                     .sender = Sender::base,
                                     .least_length = 7,
                                     .order = ByteOrder::little_endian,
                                     .signals = address_signals};
inline constexpr MessageSpec set_axis_state{.name = "SetAxisState",
                                            .id = 0x07,
                                            .sender = Sender::host,
                                            .least_length = 4,
                                            .order = ByteOrder::little_endian,
                                            .signals = axis_state_signals};
inline constexpr MessageSpec encoder_estimates{.name = "EncoderEstimates",
                                               .id = 0x09,
                                               .sender = Sender::base,
                                               .order = ByteOrder::little_endian,
                                               .period = milliseconds(10),
                                               .timeout = milliseconds(300),
                                               .signals = estimate_signals};
inline constexpr MessageSpec set_controller_mode{.name = "SetControllerMode",
                                                 .id = 0x0B,
                                                 .sender = Sender::host,
                                                 .order = ByteOrder::little_endian,
                                                 .signals = mode_signals};
inline constexpr MessageSpec set_input_velocity{.name = "SetInputVelocity",
                                                .id = 0x0D,
                                                .sender = Sender::host,
                                                .order = ByteOrder::little_endian,
                                                .period = milliseconds(20),
                                                .signals = velocity_signals};
inline constexpr MessageSpec set_input_position{.name = "SetInputPosition",
                                                .id = 0x0C,
                                                .sender = Sender::host,
                                                .least_length = 8,
                                                .order = ByteOrder::little_endian,
                                                .signals = position_signals};
inline constexpr MessageSpec set_input_torque{.name = "SetInputTorque",
                                              .id = 0x0E,
                                              .sender = Sender::host,
                                              .least_length = 4,
                                              .order = ByteOrder::little_endian,
                                              .signals = torque_signals};
inline constexpr MessageSpec set_limits{.name = "SetLimits",
                                        .id = 0x0F,
                                        .sender = Sender::host,
                                        .least_length = 8,
                                        .order = ByteOrder::little_endian,
                                        .signals = limit_signals};
inline constexpr MessageSpec currents{.name = "Currents",
                                      .id = 0x14,
                                      .sender = Sender::base,
                                      .order = ByteOrder::little_endian,
                                      .period = milliseconds(100),
                                      .signals = current_signals};
inline constexpr MessageSpec temperatures{.name = "Temperatures",
                                          .id = 0x15,
                                          .sender = Sender::base,
                                          .order = ByteOrder::little_endian,
                                          .period = milliseconds(100),
                                          .signals = temperature_signals};
inline constexpr MessageSpec torques{.name = "Torques",
                                     .id = 0x1C,
                                     .sender = Sender::base,
                                     .order = ByteOrder::little_endian,
                                     .period = milliseconds(100),
                                     .signals = torques_signals};
inline constexpr MessageSpec powers{.name = "Powers",
                                    .id = 0x1D,
                                    .sender = Sender::base,
                                    .order = ByteOrder::little_endian,
                                    .period = milliseconds(100),
                                    .signals = power_signals};
inline constexpr MessageSpec bus_voltage_current{.name = "BusVoltageCurrent",
                                                 .id = 0x17,
                                                 .sender = Sender::base,
                                                 .order = ByteOrder::little_endian,
                                                 .period = milliseconds(100),
                                                 .signals = bus_signals};
inline constexpr MessageSpec clear_errors{.name = "ClearErrors",
                                          .id = 0x18,
                                          .sender = Sender::host,
                                          .length = 1,
                                          .least_length = 0,
                                          .order = ByteOrder::little_endian,
                                          .signals = clear_signals};

inline constexpr std::array messages{version,
                                     heartbeat,
                                     estop,
                                     error,
                                     address,
                                     set_axis_state,
                                     encoder_estimates,
                                     set_controller_mode,
                                     set_input_position,
                                     set_input_velocity,
                                     set_input_torque,
                                     set_limits,
                                     currents,
                                     temperatures,
                                     bus_voltage_current,
                                     clear_errors,
                                     torques,
                                     powers};

}  // namespace tables

/// Of a request for addresses that every axis answers: sent to the node number of axes that have none yet.
inline constexpr std::uint32_t address_of_all = 0x3F * node_step + tables::address.id;

/// A drive with two axes.
inline constexpr ProtocolTable table{
    .name = "ODrive_CANSimple", .messages = tables::messages, .nodes = 2, .node_step = node_step};

}  // namespace lodestar::odrive
