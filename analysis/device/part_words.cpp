#include "analysis/device/part_words.h"

#include "core/base/definition/angular_units.h"

namespace haptrial::analysis {
namespace {

std::optional<AngularUnits::GivenUnit> given_for(const CertificateRecord& record,
                                             const std::string& unit) {
  return record.of == device::Part::kRotation ? AngularUnits(record.radius).given_for(unit)
                                              : std::nullopt;
}

void state_about_axis(const CertificateRecord& record, Finding& finding) {
  const double worth = worth_of(record, finding.unit);
  if (const double* number = finding.value.number()) {
    finding.value = worth * *number;
  }
  finding.low *= worth;
  finding.high *= worth;
  finding.unit = unit_of(record, finding.unit);
}

}  // namespace

const PartWords& words_of(device::Part part) {
  static const PartWords tip{
      "",
      "What the device does",
      "Force",
      "Position",
      "newtons",
      "wall",
      "it takes a force sensor on the handle",
      "it takes a force sensor, or a known mass on the handle (--mass)",
      "the device gives no force",
  };
  static const PartWords rotation{
      "rotation_",
      "What the device does about its axes of rotation",
      "Torque",
      "Angle",
      "newton metres",
      "rotational spring",
      "it takes a torque sensor on the handle",
      "it takes a torque sensor on the handle",
      "the device gives no torque",
  };
  static const PartWords grip{
      "grip_",
      "What the device does between the fingers",
      "Grip force",
      "Opening",
      "newtons",
      "grip spring",
      "it takes a force sensor between the fingers",
      "it takes a force sensor between the fingers",
      "the device gives no grip force",
  };
  return part == device::Part::kRotation ? rotation : part == device::Part::kGrip ? grip : tip;
}

double worth_of(const CertificateRecord& record, const std::string& unit) {
  const auto given = given_for(record, unit);
  return given ? 1.0 / given->factor : 1.0;
}

std::string unit_of(const CertificateRecord& record, const std::string& unit) {
  const auto given = given_for(record, unit);
  return given ? std::string(given->unit) : unit;
}

void state_about_axis(const CertificateRecord& record, std::vector<FindingList>& lists) {
  for (FindingList& list : lists) {
    for (Finding& one : list.findings) {
      state_about_axis(record, one);
    }
    for (FindingTable& table : list.tables) {
      for (FindingRow& row : table.rows) {
        for (Finding& one : row) {
          state_about_axis(record, one);
        }
      }
    }
  }
}

}  // namespace haptrial::analysis
