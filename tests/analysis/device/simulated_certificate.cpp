#include "tests/analysis/device/simulated_certificate.h"

namespace haptrial::test {

using analysis::CertificatePart;

analysis::CertificateRecord simulated_certificate(
    const device::VirtualDeviceParameters& electronics, const device::SensedMountParameters& mount,
    const analysis::Excitation& excitation, std::uint64_t seed,
    const std::vector<CertificatePart>& parts, double reach) {
  analysis::CertificateRecord record;
  record.device = "virtual";
  record.simulated = true;
  record.mass = mount.added_mass;
  record.axes = excitation.axes();
  for (const CertificatePart which : parts) {
    device::SensedMountParameters own = mount;
    own.added_mass = which == CertificatePart::kLoaded ? mount.added_mass : 0.0;
    device::SensedMount handle(own, seed + static_cast<std::uint64_t>(which) * 1000003);
    device::VirtualDevice device(electronics, handle, excitation.rate());
    analysis::PartRecord& part = record.parts[static_cast<std::size_t>(which)];
    const bool free = which == CertificatePart::kFree || which == CertificatePart::kLoaded;
    if (free) {
      handle.release();
    }
    device::MeasuredForce measured;
    for (long tick = 0; tick < excitation.ticks(which); ++tick) {
      device::DeviceReading reading;
      device.read(reading);
      Eigen::Vector3d command = excitation.command(which, tick);
      if (free) {
        command += excitation.centring(which, tick, reading.tool);
      }
      part.position.push_back(reading.tool.position);
      part.velocity.push_back(reading.tool.velocity);
      part.command.push_back(command);
      if (handle.read(measured)) {
        part.measured.push_back(measured.force);
      }
      if (!free) {
        handle.hold(excitation.position(which, tick + 1, reach));
      }
      device.write(command);
    }
  }
  return record;
}

}  // namespace haptrial::test
