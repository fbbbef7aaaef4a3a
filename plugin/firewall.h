// The one place where exceptions become errors: those of core, of the libraries and of the caller's callbacks.
#pragma once

#include <exception>
#include <new>

#include "core/progress.h"
#include "plugin/result.h"

namespace gltf_radiosity {

/// What `work` returns, a Result; or the Error that what it throws amounts to.
template <typename Work>
auto behind_firewall(const Work& work) -> decltype(work()) {
  try {
    return work();
  } catch (const radiosity::Cancelled&) {
    return Error{ErrorCode::kCancelled, "", "cancelled"};
  } catch (const radiosity::OutOfTime&) {
    return Error{ErrorCode::kLimit, "--time-limit", "there is not enough time for any light, so nothing is written"};
  } catch (const std::bad_alloc&) {
    return Error{ErrorCode::kLimit, "", "not enough memory"};
  } catch (const std::exception& exception) {
    return Error{ErrorCode::kInternal, "", exception.what()};
  } catch (...) {
    return Error{ErrorCode::kInternal, "", "unknown exception"};
  }
}

}  // namespace gltf_radiosity
