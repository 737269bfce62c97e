#pragma once

#include <memory>

#include "core/record/hdf5/table_in_file.h"
#include "core/record/table/table_description.h"

namespace haptrial::record {

/// A table that only its file describes: one of another program's protocol. Its words of codes are
/// not known, so that they are numbers.
class FoundTable final : public TableDescription {
 public:
  explicit FoundTable(h5::TableInFile found);

 private:
  explicit FoundTable(std::shared_ptr<const h5::TableInFile> found);
  std::shared_ptr<const h5::TableInFile> found_;  // has the texts that the description points to
};

}  // namespace haptrial::record
