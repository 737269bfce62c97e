#pragma once

#include <string>

namespace haptrial::questions {

/// Small lines below a question that say how it is answered; a definition may translate them.
struct HintTexts {
  std::string go_on{"Press Enter to go on"};
  std::string choose{"Choose with a number key or the arrows, then press Enter"};
  std::string move_mark{"Move the mark with the arrow keys or type a number, then press Enter"};
  std::string place_mark{"Move your hand along the line, then press the button or Enter"};
  std::string click_mark{"Click on the line"};
  std::string type_number{"Type a number, then press Enter"};
  std::string type_words{"Type your answer, then press Enter"};
};

}  // namespace haptrial::questions
