#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "plugin/check_document.h"

namespace gltf_radiosity {
namespace {

constexpr const char* kExtension = "EXT_lights_image_based";

class EnvironmentChecker : private JsonChecker {
 public:
  using JsonChecker::JsonChecker;

  Result<Done> run() {
    std::size_t light_count = 0;
    if (const Json* extension = extension_of(root_, kExtension)) {
      if (!extension->is_object()) return bad_input("extensions", fmt::format("{} is not an object", kExtension));
      const std::string place = fmt::format("extensions.{}", kExtension);
      const Json& lights = array_in(*extension, "lights", place);
      light_count = lights.size();
      for (std::size_t i = 0; i < light_count; ++i) check_light(lights[i], place_of(place + ".lights", i));
    }
    for (std::size_t i = 0; i < size("scenes"); ++i) {
      const Json* reference = extension_of(root_["scenes"][i], kExtension);
      if (reference == nullptr) continue;
      const std::string place = place_of("scenes", i);
      const std::uint64_t light = number(*reference, "light", std::nullopt, place);
      if (light >= light_count) {
        fail(place, fmt::format("refers to image-based light {}, but there are {}", light, light_count));
      }
    }
    return result();
  }

 private:
  void check_light(const Json& light, const std::string& place) {
    if (!light.is_object()) return fail(place, "is not an object");
    number_if_present(light, "intensity", place);
    numbers(light, "rotation", 4, place);
    check_coefficients(light, place);
    for (const Json& faces : array_in(light, "specularImages", place)) {
      const bool fine =
          faces.is_array() && faces.size() == 6 && std::all_of(faces.begin(), faces.end(), [&](const Json& face) {
            const auto index = whole_number(face);
            return index && *index < size("images");
          });
      if (!fine) fail(place, R"("specularImages" are not six images of the file for each level)");
    }
    if (!light.contains("specularImages") && !light.contains("irradianceCoefficients")) {
      fail(place, R"(has neither "specularImages" nor "irradianceCoefficients")");
    }
  }

  void check_coefficients(const Json& light, const std::string& place) {
    const Json& coefficients = array_in(light, "irradianceCoefficients", place);
    if (!light.contains("irradianceCoefficients")) return;
    const auto is_color = [](const Json& color) {
      return color.is_array() && color.size() == 3 && std::all_of(color.begin(), color.end(), [](const Json& band) {
               return band.is_number() && std::isfinite(band.get<float>());
             });
    };
    if (coefficients.size() != 9 || !std::all_of(coefficients.begin(), coefficients.end(), is_color)) {
      fail(place, "\"irradianceCoefficients\" are not nine times three finite numbers");
    }
  }
};

}  // namespace

Result<Done> check_environment(const Json& root) { return EnvironmentChecker(root).run(); }

}  // namespace gltf_radiosity
