#include "protocols/interface/drawing.h"

#include <utility>

namespace haptrial::protocols {
namespace {

using Page = std::function<render::TextPage(const stimulus::Shown&)>;
constexpr render::Colour kPaper{0.0, 0.0, 0.0, 1.0};
constexpr render::Colour kInk{1.0, 1.0, 1.0, 1.0};

class TextDrawing final : public Drawing {
 public:
  TextDrawing(Page page, const render::Gl& gl, int width, int height)
      : page_(std::move(page)), screen_(gl, width, height, kPaper, kInk, kInk) {}
  void draw(const stimulus::Shown& shown) override { screen_.draw(page_(shown)); }

 private:
  Page page_;
  render::TextScreen screen_;
};

}  // namespace

MakeDrawing text_drawing(Page page) {
  return [page = std::move(page)](const render::Gl& gl, int width, int height) {
    return std::make_unique<TextDrawing>(page, gl, width, height);
  };
}

}  // namespace haptrial::protocols
