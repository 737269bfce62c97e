#pragma once

#include <string>
#include <vector>

#include "analysis/device/certificate_record.h"
#include "analysis/document/finding.h"

namespace haptrial::analysis {

/// Words for the figures of one part of a handle.
struct PartWords {
  const char* prefix;   // of the names of its findings and pictures
  const char* heading;  // of its summary
  const char* force;    // that it gives
  const char* place;
  const char* newtons;  // of a command
  const char* wall;
  const char* needs_sensor;  // completes "not defined, because", likewise below
  const char* needs_either;  // a sensor or a known mass
  const char* none;          // there are no motors for it
};
const PartWords& words_of(device::Part part);

/// Turns findings of a rotation, which are those at the fingers, into those about its axis: N into
/// N·m, m into rad, kg into kg·m². Those of other parts stay as they are.
void state_about_axis(const CertificateRecord& record, std::vector<FindingList>& lists);

/// The number of the part's own units in one unit at the fingers; 1 unless the part is a rotation.
/// @param unit  of the fingers, such as "N/m"
double worth_of(const CertificateRecord& record, const std::string& unit);
/// That unit as the part has it: "N·m/rad".
std::string unit_of(const CertificateRecord& record, const std::string& unit);

}  // namespace haptrial::analysis
