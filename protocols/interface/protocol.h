#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "protocols/definition/definition.h"
#include "protocols/interface/auxiliary_page.h"
#include "protocols/interface/replay.h"
#include "protocols/interface/trials.h"

namespace haptrial::protocols {

/// A kind of experiment: what [experiment] of a definition names. It is one object without state;
/// the registry of studies holds it (experiments/studies/registry.h).
class Protocol {
 public:
  virtual ~Protocol() = default;
  virtual std::string_view name() const = 0;
  /// Another word that a definition may use for it; empty: none.
  virtual std::string_view synonym() const { return ""; }
  /// A definition from a table that others read on: its problems are noted and still to be thrown.
  /// @param folder  of the file, for what it names; null for a text that a session file keeps
  virtual std::unique_ptr<Definition> read(Table& root, std::string_view file_name,
                                           const std::filesystem::path* folder) const = 0;
  /// Definition::margins() of the published parameters, if there are any.
  virtual std::vector<std::string> margins() const { return {}; }
  /// Loads parts that take seconds, once all of the definition is known to be good. @param
  /// folder  of the file
  virtual void load(Definition& definition, const std::filesystem::path& folder) const {
    static_cast<void>(definition);
    static_cast<void>(folder);
  }
  /// Purposes of the passes of a trial, each with its meaning: the words of /trials.
  virtual std::vector<std::pair<record::Phase, std::string>> phases() const = 0;
  /// The tables of a definition that only virtual participants use.
  virtual std::vector<std::string> virtual_tables() const { return {}; }
  /// Every table of its own that a session of it may record.
  virtual record::TableList tables() const { return {}; }
  /// The pages beside the console that a session of the definition has to offer, new ones.
  /// @param definition  of this protocol
  virtual AuxiliaryPages auxiliary_pages(const Definition& definition) const {
    static_cast<void>(definition);
    return {};
  }
  /// The definition of a session of one case, for definitions whose sessions are of cases.
  /// @throws InputError if it has no such case, by default always
  virtual std::unique_ptr<Definition> of_case(const Definition& definition,
                                              const std::string& name) const;
  /// The trials of one session. @param definition  of this protocol; it and the place outlive them
  virtual std::unique_ptr<Trials> trials(const Definition& definition,
                                         const SessionPlace& place) const = 0;
  /// Blocks that a session presents, in its order and in the definition's words; none if the
  /// protocol has no such words. @param definition  of this protocol
  virtual std::vector<std::string> blocks(const Definition& definition,
                                          const SessionPlace& place) const {
    static_cast<void>(definition);
    static_cast<void>(place);
    return {};
  }
  /// Whether a recording can be presented again with this definition, loaded.
  /// @throws InputError if a file that the definition names is another than it was recorded with
  virtual void check_replayed(const Definition& definition,
                              const record::SessionReader& file) const {
    static_cast<void>(definition);
    static_cast<void>(file);
  }
  /// Goes through recorded trials again, and says what came of it.
  /// @throws InputError for what the file does not hold, or if the protocol cannot; RunError if it
  ///         differs from the recording
  virtual void replay(const ReplayRequest& request) const;
};

}  // namespace haptrial::protocols
