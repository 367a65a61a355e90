// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/page/packed_text.h"

#include <zlib.h>

#include <stdexcept>
#include <vector>

#include <boost/beast/core/detail/base64.hpp>

namespace touchdown::evaluation {

std::string PackText(std::string_view text) {
  namespace base64 = boost::beast::detail::base64;
  uLongf length = compressBound(text.size());
  std::vector<Bytef> bytes(length);
  if (compress2(bytes.data(), &length, reinterpret_cast<const Bytef*>(text.data()), text.size(),
                Z_BEST_COMPRESSION) != Z_OK) {
    throw std::runtime_error("zlib has no memory for the page");
  }
  std::string packed(base64::encoded_size(length), '\0');
  packed.resize(base64::encode(packed.data(), bytes.data(), length));
  return packed;
}

}  // namespace touchdown::evaluation
