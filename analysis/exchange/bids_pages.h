#pragma once

#include <span>
#include <string>
#include <vector>

#include "analysis/exchange/bids_text.h"

namespace haptrial::exchange::bids {

/// A page that participants answered, as a measurement of BIDS below phenotype/.
struct Phenotype {
  std::string name;  // of its files, without extension
  std::string table;
  std::vector<ColumnDoc> columns;
};

/// All pages but those of consent, in the order in which they first occur. A page that was shown
/// several times has a row each time.
/// @param kind  of the tables
std::vector<Phenotype> phenotypes(std::span<const Session> sessions, Delimited kind);

}  // namespace haptrial::exchange::bids
