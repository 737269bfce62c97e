#pragma once

#include <iosfwd>

namespace haptrial::experiments {

/// Makes the pages that lines ask for, until the input ends: for who asks again and again, since
/// bodies and bones that take long to be prepared are kept. The first line of the output is "{}".
/// Then each line of the input is answered by one, both JSON objects; "headings" may be left out:
///
///     {"file": "study.toml", "trial": 1, "virtual": true, "headings": "de",
///      "out": "page.html"}
///     {"page": "page.html"} or {"failure": "sentences"}
void answer_page_requests(std::istream& in, std::ostream& out);

}  // namespace haptrial::experiments
