#pragma once

#include "drivers/base/protocol_table.hpp"

// AgileX protocol V2 as a table, from the user manuals of Tracer, Scout and Hunter.
namespace lodestar::agilex {

namespace tables {

using enum SignalKind;
using std::chrono::milliseconds;

inline constexpr std::array velocity{
    Signal{
        .name = "ForwardSpeed", .byte = 0, .bits = 16, .kind = signed_integer, .scale = 0.001, .unit = "m/s"},
    Signal{
        .name = "TurnSpeed", .byte = 2, .bits = 16, .kind = signed_integer, .scale = 0.001, .unit = "rad/s"},
    Signal{
        .name = "LateralSpeed", .byte = 4, .bits = 16, .kind = signed_integer, .scale = 0.001, .unit = "m/s"},
    Signal{.name = "SteeringAngle",
           .byte = 6,
           .bits = 16,
           .kind = signed_integer,
           .scale = 0.001,
           .unit = "rad"}};
inline constexpr std::array mode{Signal{.name = "Mode", .byte = 0}};
inline constexpr std::array cleared{Signal{.name = "Motor", .byte = 0}};
inline constexpr std::array system{
    Signal{.name = "VehicleState", .byte = 0}, Signal{.name = "ControlMode", .byte = 1},
    Signal{.name = "Battery", .byte = 2, .bits = 16, .scale = 0.1, .unit = "V"},
    Signal{.name = "FaultBits", .byte = 4, .bits = 16}, Signal{.name = "Counter", .byte = 7}};
inline constexpr std::array odometer{
    Signal{.name = "LeftTravel", .byte = 0, .bits = 32, .kind = signed_integer, .unit = "mm"},
    Signal{.name = "RightTravel", .byte = 4, .bits = 32, .kind = signed_integer, .unit = "mm"}};
inline constexpr std::array remote{Signal{.name = "SwitchA", .byte = 0, .bits = 2, .bit = 0},
                                   Signal{.name = "SwitchB", .byte = 0, .bits = 2, .bit = 2},
                                   Signal{.name = "SwitchC", .byte = 0, .bits = 2, .bit = 4},
                                   Signal{.name = "SwitchD", .byte = 0, .bits = 2, .bit = 6},
                                   Signal{.name = "RightStickH", .byte = 1, .kind = signed_integer},
                                   Signal{.name = "RightStickV", .byte = 2, .kind = signed_integer},
                                   Signal{.name = "LeftStickV", .byte = 3, .kind = signed_integer},
                                   Signal{.name = "LeftStickH", .byte = 4, .kind = signed_integer}};
inline constexpr std::array motor_fast{
    Signal{.name = "Speed", .byte = 0, .bits = 16, .kind = signed_integer, .unit = "rpm"},
    Signal{.name = "Current", .byte = 2, .bits = 16, .kind = signed_integer, .scale = 0.1, .unit = "A"},
    Signal{.name = "Pulses", .byte = 4, .bits = 32, .kind = signed_integer}};
inline constexpr std::array motor_slow{
    Signal{.name = "Supply", .byte = 0, .bits = 16, .scale = 0.1, .unit = "V"},
    Signal{.name = "DriverTemperature", .byte = 2, .bits = 16, .kind = signed_integer, .unit = "degC"},
    Signal{.name = "MotorTemperature", .byte = 4, .kind = signed_integer, .unit = "degC"},
    Signal{.name = "DriverState", .byte = 5}};
inline constexpr std::array battery{
    Signal{.name = "Charge", .byte = 0, .unit = "%"}, Signal{.name = "Health", .byte = 1, .unit = "%"},
    Signal{.name = "Voltage", .byte = 2, .bits = 16, .scale = 0.1, .unit = "V"},
    Signal{.name = "Current", .byte = 4, .bits = 16, .kind = signed_integer, .scale = 0.1, .unit = "A"},
    Signal{
        .name = "Temperature", .byte = 6, .bits = 16, .kind = signed_integer, .scale = 0.1, .unit = "degC"}};

inline constexpr std::array battery_more{
    Signal{.name = "Alarms1", .byte = 0}, Signal{.name = "Alarms2", .byte = 1},
    Signal{.name = "Warnings1", .byte = 2}, Signal{.name = "Warnings2", .byte = 3}};
inline constexpr std::array light{Signal{.name = "ByCommand", .byte = 0},  // or by the base's own logic
                                  Signal{.name = "FrontMode", .byte = 1},  // off, on, breathing, custom
                                  Signal{.name = "FrontBrightness", .byte = 2, .unit = "%"},
                                  Signal{.name = "RearMode", .byte = 3},
                                  Signal{.name = "RearBrightness", .byte = 4, .unit = "%"},
                                  Signal{.name = "Counter", .byte = 7}};
inline constexpr std::array version_question{Signal{.name = "Ask", .byte = 0}};
inline constexpr std::array version_numbers{Signal{.name = "ControllerHardware", .byte = 0, .bits = 16},
                                            Signal{.name = "DriverHardware", .byte = 2, .bits = 16},
                                            Signal{.name = "ControllerSoftware", .byte = 4, .bits = 16},
                                            Signal{.name = "DriverSoftware", .byte = 6, .bits = 16}};
/// Eight characters; ten such frames are the whole text.
inline constexpr std::array version_letters{
    Signal{.name = "Letter1", .byte = 0}, Signal{.name = "Letter2", .byte = 1},
    Signal{.name = "Letter3", .byte = 2}, Signal{.name = "Letter4", .byte = 3},
    Signal{.name = "Letter5", .byte = 4}, Signal{.name = "Letter6", .byte = 5},
    Signal{.name = "Letter7", .byte = 6}, Signal{.name = "Letter8", .byte = 7}};

inline constexpr MessageSpec motion_command{.name = "MotionCommand",
                                            .id = 0x111,
                                            .sender = Sender::host,
                                            .period = milliseconds(20),
                                            .timeout = milliseconds(500),
                                            .signals = velocity};
inline constexpr MessageSpec control_mode{.name = "ControlModeCommand",
                                          .id = 0x421,
                                          .sender = Sender::host,
                                          .length = 1,
                                          .least_length = 1,
                                          .signals = mode};
inline constexpr MessageSpec clear_fault{.name = "ClearFaultCommand",
                                         .id = 0x441,
                                         .sender = Sender::host,
                                         .length = 1,
                                         .least_length = 1,
                                         .signals = cleared};
inline constexpr MessageSpec light_command{
    .name = "LightCommand", .id = 0x121, .sender = Sender::host, .signals = light};
inline constexpr MessageSpec light_state{
    .name = "LightState", .id = 0x231, .sender = Sender::base, .period = milliseconds(20), .signals = light};
inline constexpr MessageSpec version_request{.name = "VersionRequest",
                                             .id = 0x411,
                                             .sender = Sender::host,
                                             .length = 1,
                                             .least_length = 1,
                                             .signals = version_question};
inline constexpr MessageSpec version_answer{
    .name = "Version", .id = 0x41A, .sender = Sender::base, .signals = version_numbers};
/// Requested by a frame of one byte, 1, with the same identifier.
inline constexpr MessageSpec version_text{
    .name = "VersionText", .id = 0x4A1, .sender = Sender::base, .signals = version_letters};
inline constexpr MessageSpec system_state{.name = "SystemState",
                                          .id = 0x211,
                                          .sender = Sender::base,
                                          .period = milliseconds(20),
                                          .timeout = milliseconds(300),
                                          .signals = system};
inline constexpr MessageSpec motion_state{.name = "MotionState",
                                          .id = 0x221,
                                          .sender = Sender::base,
                                          .period = milliseconds(20),
                                          .timeout = milliseconds(300),
                                          .signals = velocity};
inline constexpr MessageSpec remote_state{.name = "RemoteState",
                                          .id = 0x241,
                                          .sender = Sender::base,
                                          .period = milliseconds(20),
                                          .signals = remote};
inline constexpr MessageSpec motor1_fast{.name = "Motor1HighSpeed",
                                         .id = 0x251,
                                         .sender = Sender::base,
                                         .period = milliseconds(20),
                                         .signals = motor_fast};
inline constexpr MessageSpec motor2_fast{.name = "Motor2HighSpeed",
                                         .id = 0x252,
                                         .sender = Sender::base,
                                         .period = milliseconds(20),
                                         .signals = motor_fast};
inline constexpr MessageSpec motor1_slow{.name = "Motor1LowSpeed",
                                         .id = 0x261,
                                         .sender = Sender::base,
                                         .period = milliseconds(100),
                                         .signals = motor_slow};
inline constexpr MessageSpec motor2_slow{.name = "Motor2LowSpeed",
                                         .id = 0x262,
                                         .sender = Sender::base,
                                         .period = milliseconds(100),
                                         .signals = motor_slow};
inline constexpr MessageSpec odometer_state{.name = "Odometer",
                                            .id = 0x311,
                                            .sender = Sender::base,
                                            .period = milliseconds(20),
                                            .timeout = milliseconds(300),
                                            .signals = odometer};
inline constexpr MessageSpec battery_state{
    .name = "Battery", .id = 0x361, .sender = Sender::base, .period = milliseconds(500), .signals = battery};

inline constexpr MessageSpec battery_extended{.name = "BatteryExtended",
                                              .id = 0x362,
                                              .sender = Sender::base,
                                              .period = milliseconds(500),
                                              .signals = battery_more};

inline constexpr std::array messages{
    motion_command, control_mode,   clear_fault,   light_command,    version_request, system_state,
    motion_state,   light_state,    remote_state,  motor1_fast,      motor2_fast,     motor1_slow,
    motor2_slow,    odometer_state, battery_state, battery_extended, version_answer,  version_text};

}  // namespace tables

inline constexpr ProtocolTable table{.name = "AgileX_V2", .messages = tables::messages};

}  // namespace lodestar::agilex
