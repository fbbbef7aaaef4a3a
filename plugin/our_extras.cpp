#include "plugin/our_extras.h"

#include <utility>

namespace gltf_radiosity {

Json& our_extras(Json& owner) {
  if (owner.contains("extras") && !owner["extras"].is_object()) {
    Json original = std::move(owner["extras"]);
    owner["extras"] = Json::object();
    owner["extras"]["original"] = std::move(original);
  }
  return owner["extras"]["radiosity"];
}

}  // namespace gltf_radiosity
