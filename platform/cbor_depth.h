#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace cgsr {

/// How deep the items of a CBOR file of this program may nest, the outermost counted; its own files need far fewer. Ours.
inline constexpr int kMaxCborDepth = 16;

/// Walks the first item of a CBOR record (RFC 8949, section 3) without recursion and without storing it, for parsers that recurse per level:
/// a megabyte of 0x9F or 0x7F would exhaust their stack. Arrays, maps, tags, and strings of indefinite length, whose chunks
/// are items of their own, each are a level.
///
/// Where the bytes are no well-formed CBOR the walk ends without a finding: that is the parser's to say, and it gets no further. Ours.
///
/// \return where the first item lies that is deeper than kMaxCborDepth, how deep it is and what was expected, for people; nothing: none is.
std::optional<std::string> cbor_depth_problem(std::span<const std::uint8_t> bytes);

}  // namespace cgsr
