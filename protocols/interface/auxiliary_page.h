#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace haptrial::protocols {

/// A page beside the experimenter's console, for somebody else who watches a session and asks
/// something of it. A protocol makes it for a definition, the console serves it, and the session
/// that is under way finds it in its place (page_of()). Any thread but the servo's, several at
/// once.
class AuxiliaryPage {
 public:
  /// The next event as one line of JSON: what came since the last one.
  using Events = std::function<std::string()>;

  virtual ~AuxiliaryPage() = default;
  /// End of the page's address: letters a to z and '_', such as "assistant".
  virtual std::string_view name() const = 0;
  /// Title of the page for the terminal, such as "assistant's page".
  virtual std::string_view title() const = 0;
  /// Whether it changes what is presented, so that only a pilot may have it.
  virtual bool is_for_pilots() const { return false; }
  /// The page. Its scripts and styles carry nonce="NONCE"; it hears /NAME/events?token=T and posts
  /// to /NAME/ask with the header X-Haptrial-Token, as the console's own page does.
  virtual std::string_view html() const = 0;
  /// A viewer for a page that is opened now; each page has its own.
  virtual Events events() = 0;
  /// @param json  body of a request, of at most 4 KiB
  /// @throws InputError for what the page does not take
  virtual void ask(const std::string& json) = 0;
};

using AuxiliaryPages = std::vector<std::shared_ptr<AuxiliaryPage>>;

/// The page of a kind among others; null if it is not served.
template <class Page>
std::shared_ptr<Page> page_of(const AuxiliaryPages& pages) {
  for (const std::shared_ptr<AuxiliaryPage>& page : pages) {
    if (auto found = std::dynamic_pointer_cast<Page>(page)) {
      return found;
    }
  }
  return nullptr;
}

}  // namespace haptrial::protocols
