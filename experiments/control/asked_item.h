#pragma once

#include <memory>
#include <string>
#include <vector>

namespace haptrial::experiments {

/// A page's question at the moment, for those who answer it elsewhere than in the participant's
/// window.
struct AskedItem {
  int number{0};         // counts what was asked, from 1; 0: nothing is asked
  std::string kind;      // word of its kind of question: "read", "choice", "scale"
  bool asks{true};       // false: a text that is only read
  bool consents{false};  // only with a reason may an experimenter agree
  std::string title;
  std::string text;
  std::vector<std::string> choices;  // labels
  double low{0.0}, high{0.0};        // of a number; both 0: it is none
  double step{1.0};
  std::string low_end, high_end;
  std::string hint;
  bool back{false};          // the participant may go back to the item before
  std::string given;         // the answer so far, as PageInput::give() takes it; empty: none yet
  std::string picture_file;  // as the definition names it; empty: none
  std::shared_ptr<const std::string> picture;  // its bytes, a PNG file; null: none
};

}  // namespace haptrial::experiments
