#include "tests/fuzz/mutate_json.h"

#include <array>
#include <string>
#include <vector>

namespace gltf_radiosity::fuzz {
namespace {

/// The keys and words of glTF (gltf.dict, made into a list by CMake).
constexpr const char* kWords[] = {
#include "gltf_words.inc"
};

/// Where readers go wrong: the ends of integer types, what floats cannot hold, and glTF's own constants.
constexpr std::array kNumbers = {0.0,
                                 1.0,
                                 -1.0,
                                 2.0,
                                 3.0,
                                 4.0,
                                 5.0,
                                 6.0,
                                 0.5,
                                 -0.5,
                                 63.0,
                                 255.0,
                                 256.0,
                                 65535.0,
                                 65536.0,
                                 5120.0,
                                 5121.0,
                                 5122.0,
                                 5123.0,
                                 5125.0,
                                 5126.0,
                                 1e-40,
                                 1e10,
                                 2147483647.0,
                                 2147483648.0,
                                 4294967295.0,
                                 4294967296.0,
                                 1099511627776.0,
                                 9007199254740992.0,
                                 1.8446744073709552e19,
                                 1e30,
                                 1e38,
                                 -1e38,
                                 3.5e38,
                                 1e308,
                                 1e-308};

const char* any_word(Random& random) { return kWords[choose(random, std::size(kWords))]; }

/// Whole ones as integers, as writers store them.
Json any_number(Random& random) {
  const double number = kNumbers[choose(random, kNumbers.size())];
  const bool whole =
      number >= -1e15 && number <= 1e15 && number == static_cast<double>(static_cast<std::int64_t>(number));
  return whole ? Json(static_cast<std::int64_t>(number)) : Json(number);
}

Json any_value(Random& random) {
  switch (choose(random, 8)) {
    case 0:
      return nullptr;
    case 1:
      return choose(random, 2) == 0;
    case 2:
      return any_word(random);
    case 3:
      return Json::array();
    case 4:
      return Json::object();
    case 5:
      return Json::array({any_number(random), any_number(random), any_number(random)});
    default:
      return any_number(random);
  }
}

/// Every value below `value`, and itself.
void collect(Json& value, std::vector<Json*>& all) {
  all.push_back(&value);
  if (!value.is_structured()) return;
  for (Json& child : value) collect(child, all);
}

std::vector<Json*> values_of(Json& root) {
  std::vector<Json*> all;
  collect(root, all);
  return all;
}

void change_number(Json& value, Random& random) {
  const double number = value.get<double>();
  switch (choose(random, 4)) {
    case 0:
      value = any_number(random);
      break;
    case 1:
      value = choose(random, 8);  // another index
      break;
    case 2:
      value = number + (choose(random, 2) == 0 ? 1.0 : -1.0);
      break;
    default:
      value = number * static_cast<double>(kNumbers[choose(random, 12)]);
  }
}

void change_array(Json& array, Random& random) {
  if (array.empty() || choose(random, 4) == 0) {
    array.push_back(any_value(random));
  } else if (choose(random, 2) == 0) {
    array.erase(array.begin() + static_cast<std::ptrdiff_t>(choose(random, array.size())));
  } else {
    array.push_back(Json(array[choose(random, array.size())]));
  }
}

void change_object(Json& object, Random& random) {
  if (object.empty() || choose(random, 2) == 0) {
    object[any_word(random)] = any_value(random);
    return;
  }
  auto member = object.begin();
  std::advance(member, static_cast<std::ptrdiff_t>(choose(random, object.size())));
  object.erase(member.key());
}

}  // namespace

void mutate_json(Json& root, Random& random) {
  const std::vector<Json*> all = values_of(root);
  Json& value = *all[choose(random, all.size())];
  const std::size_t what = choose(random, 8);
  if (what == 0 && &value != &root) {
    value = any_value(random);
  } else if (what == 1 && &value != &root) {
    value = Json(*all[choose(random, all.size())]);
  } else if (value.is_number()) {
    change_number(value, random);
  } else if (value.is_string()) {
    value = any_word(random);
  } else if (value.is_boolean()) {
    value = !value.get<bool>();
  } else if (value.is_array()) {
    change_array(value, random);
  } else if (value.is_object()) {
    change_object(value, random);
  }
}

void graft(Json& root, Json& other, Random& random) {
  const std::vector<Json*> places = values_of(root), branches = values_of(other);
  Json& place = *places[choose(random, places.size())];
  const Json branch = *branches[choose(random, branches.size())];
  if (place.is_array()) {
    place.push_back(branch);
  } else if (place.is_object() && branch.is_object()) {
    place.update(branch);
  } else if (&place != &root) {
    place = branch;
  }
}

}  // namespace gltf_radiosity::fuzz
