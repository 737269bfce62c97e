#pragma once

#include <string>

#include "analysis/exchange/bids_text.h"

namespace haptrial::exchange {
class NewFolder;
}

// The movement of the devices' tips as Motion-BIDS wants it; for export_bids.cpp only.
namespace haptrial::exchange::bids {

/// Path of the recording below the subject's folder: "motion/sub-S01_…_tracksys-device_motion.tsv".
std::string motion_file(const Session& session);

/// Writes position and velocity of each device's tip, one tick in each period of `rate`, with the
/// files that describe the columns, and the events once more, since readers look for them beside
/// the movement. A tick that is missing is a row of "n/a". Nothing is filtered.
/// @param rate  [Hz], at most that of the session's loop
/// @throws InputError for a higher rate or a damaged file; RunError when the disk is full
void write_motion(const NewFolder& out, const Session& session, const record::SessionReader& reader,
                  double rate, const std::string& events);

}  // namespace haptrial::exchange::bids
