#include "scene/writer.h"

#include "scene/describe.h"
#include "scene/showing_form.h"

namespace tsubu::scene {

std::string write(const Scene& scene) {
  Scene copy = scene;  // forms take values by reference, for those that fill them
  ShowingForm form;
  describe(form, copy);
  return form.text();
}

}  // namespace tsubu::scene
