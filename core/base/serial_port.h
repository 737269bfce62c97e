#pragma once

#include <string>

namespace haptrial {

/// Whether open_serial_port() knows the rate: 9600, 19200, 38400, 57600, 115200, 230400, 460800 or
/// 921600 [bit/s].
bool has_serial_rate(int baud) noexcept;

/// Opens a serial line raw: 8 bits, no parity, one stop bit, no flow control; reads and writes do
/// not wait. The caller closes the file. Any thread but the servo thread.
/// @param device  such as /dev/ttyUSB0
/// @returns the file; -1 if it cannot be opened, with the reason in errno: ENOTTY if it is no
/// serial
///          line, EINVAL for an unknown rate
int open_serial_port(const std::string& device, int baud) noexcept;

}  // namespace haptrial
