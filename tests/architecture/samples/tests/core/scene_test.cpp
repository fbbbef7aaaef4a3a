// The tests of core need nothing above it.
#include "core/scene.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>  // forbidden

#include "plugin/document.h"  // forbidden
#include "tests/core/test_scenes.h"
