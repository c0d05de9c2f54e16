#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

namespace cgsr {

/// How outputs are written down once and read by everybody: CSV, JSON, schemas, tables of the documentation, digests.
///
/// An output is a plain default-constructible struct with one static member template that names every field, as parameters have
/// (platform/parameters.h):
///
///     struct Lamp {
///       LampStatus status = LampStatus::kNotFound;
///       double height_m = 0.0;
///       std::optional<Sighting> sighting;  // another described struct
///
///       template <class Self, class Visitor>
///       static void describe(Self& self, Visitor& visit) {
///         visit.choice("status", self.status, LampStatus::kNotFound, "whether the lamp was located, or why not");
///         visit.number("height_m", when(self.status == LampStatus::kFound, self.height_m), {3}, "m", "height over the floor");
///         visit.section("sighting", self.sighting, "what was seen of it");
///       }
///     };
///
///     append_csv_row(row, lamp);                 // "found,2.310,…"        platform/description/csv.h
///     append_json(message, lamp);                // {"status":"found",…}   platform/description/json.h
///     json_schema<Lamp>("cgsr/Lamp", "The lamp") // draft 2020-12          platform/description/json.h
///     markdown_fields<Lamp>()                    // a table for docs/      platform/description/markdown.h
///     append_to_digest(sha256, lamp);            // fixed binary order     platform/description/digest.h
///
/// The members of the visitor, in the order of the fields of every reader:
///   number(name, value, {decimals}, unit, meaning)   floating point; `decimals` are those of a text for people
///   integer(name, value, unit, meaning)              any integer within the range of std::int64_t
///   flag(name, value, meaning)                       bool
///   choice(name, value, last, meaning)               enum from 0 to `last` without gaps, with a to_string() beside its type
///   text(name, value, meaning)                       std::string or a view; words for people, not part of a digest
///   section(name, struct, meaning)                   another output; to have its fields without a prefix, call its describe()
///   list(name, range of structs, meaning)            as many outputs of one type as there are
/// A value may be a std::optional (see when()): empty means that it is not there now. A number that is not finite is not there
/// either. describe() must name the same fields whatever the values are.
///
/// Visiting allocates nothing; what a reader allocates its header says.
struct Decimals {
  int count;
};

/// \return the value when there is one: `when(found, box.x)`.
template <class T>
constexpr std::optional<T> when(bool there, const T& value) {
  return there ? std::optional<T>(value) : std::nullopt;
}

/// One field as readers see it. The views live as long as the visit.
struct Field {
  enum class Kind : std::uint8_t { kNumber, kInteger, kFlag, kChoice, kText };

  Kind kind = Kind::kNumber;
  std::string_view name;
  std::string_view unit;  ///< empty: none.
  std::string_view meaning;
  bool optional = false;  ///< its type allows that it is not there.
  bool present = true;    ///< it is there now; else no value below counts.
  int decimals = 0;       ///< of a number.
  int choices = 0;        ///< of a choice: how many there are.
  std::string_view (*choice_at)(int) = nullptr;

  double number = 0.0;
  std::int64_t integer = 0;  ///< also of a flag (0, 1) and a choice.
  std::string_view text;     ///< also of a choice: its to_string().
};

namespace description {

template <class T>
struct ValueOf {
  using Type = T;
  static constexpr bool kOptional = false;
  static const T* get(const T& value) { return &value; }
};
template <class T>
struct ValueOf<std::optional<T>> {
  using Type = T;
  static constexpr bool kOptional = true;
  static const T* get(const std::optional<T>& value) { return value ? &*value : nullptr; }
};

/// The word of an enumerator, a view of text that lives forever.
template <class Enum>
std::string_view word_of(int value) {
  static_assert(std::is_enum_v<Enum> && !std::is_same_v<decltype(to_string(Enum{})), std::string>,
                "to_string() of an enum returns a view of a literal");
  return to_string(static_cast<Enum>(value));
}

}  // namespace description

/// The visitor that describe() meets: turns typed fields into Field and hands them to a reader, whose members are
///   static constexpr bool kOfType     it reads the type (header, schema, table): a list shows one default element
///   field(const Field&)
///   begin_section(name, meaning, optional, present), end_section()
///   begin_list(name, meaning, count), end_list(), and around each element begin_element(), end_element()
template <class Reader>
class FieldVisitor {
 public:
  explicit FieldVisitor(Reader& reader) : reader_(reader) {}

  template <class T>
  void number(std::string_view name, const T& value, Decimals decimals, std::string_view unit,
              std::string_view meaning) {
    const auto* number = value_of(value);
    static_assert(std::is_floating_point_v<std::remove_cvref_t<decltype(*number)>>);
    Field field = header<T>(Field::Kind::kNumber, name, unit, meaning);
    field.decimals = decimals.count;
    if (number != nullptr) field.number = static_cast<double>(*number);
    hand_over(field, number != nullptr && std::isfinite(field.number));
  }

  template <class T>
  void integer(std::string_view name, const T& value, std::string_view unit, std::string_view meaning) {
    const auto* integer = value_of(value);
    static_assert(std::is_integral_v<std::remove_cvref_t<decltype(*integer)>>);
    Field field = header<T>(Field::Kind::kInteger, name, unit, meaning);
    if (integer != nullptr) field.integer = static_cast<std::int64_t>(*integer);
    hand_over(field, integer != nullptr);
  }

  template <class T>
  void flag(std::string_view name, const T& value, std::string_view meaning) {
    const auto* flag = value_of(value);
    static_assert(std::is_same_v<std::remove_cvref_t<decltype(*flag)>, bool>);
    Field field = header<T>(Field::Kind::kFlag, name, "", meaning);
    if (flag != nullptr) field.integer = *flag ? 1 : 0;
    hand_over(field, flag != nullptr);
  }

  template <class T, class Enum>
  void choice(std::string_view name, const T& value, Enum last, std::string_view meaning) {
    const Enum* choice = value_of(value);
    Field field = header<T>(Field::Kind::kChoice, name, "", meaning);
    field.choices = static_cast<int>(last) + 1;
    field.choice_at = &description::word_of<Enum>;
    if (choice != nullptr) {
      field.integer = static_cast<std::int64_t>(*choice);
      field.text = description::word_of<Enum>(static_cast<int>(*choice));
    }
    hand_over(field, choice != nullptr);
  }

  template <class T>
  void text(std::string_view name, const T& value, std::string_view meaning) {
    const auto* text = value_of(value);
    Field field = header<T>(Field::Kind::kText, name, "", meaning);
    if (text != nullptr) field.text = std::string_view(*text);
    hand_over(field, text != nullptr);
  }

  template <class T>
  void section(std::string_view name, const T& value, std::string_view meaning) {
    using Struct = typename description::ValueOf<T>::Type;
    const Struct* there = value_of(value);
    const bool outer = present_;
    present_ = outer && there != nullptr;
    reader_.begin_section(name, meaning, description::ValueOf<T>::kOptional, present_);
    if (there != nullptr) {
      Struct::describe(*there, *this);
    } else {
      const Struct nothing{};
      Struct::describe(nothing, *this);
    }
    reader_.end_section();
    present_ = outer;
  }

  template <class Structs>
  void list(std::string_view name, const Structs& values, std::string_view meaning) {
    using Struct = std::remove_cvref_t<decltype(*std::begin(values))>;
    reader_.begin_list(name, meaning, present_ ? std::size(values) : 0);
    if constexpr (Reader::kOfType) {
      element(Struct{});
    } else if (present_) {
      for (const Struct& value : values) element(value);
    }
    reader_.end_list();
  }

 private:
  template <class T>
  static auto value_of(const T& value) {
    return description::ValueOf<T>::get(value);
  }

  template <class T>
  static Field header(Field::Kind kind, std::string_view name, std::string_view unit, std::string_view meaning) {
    Field field;
    field.kind = kind;
    field.name = name;
    field.unit = unit;
    field.meaning = meaning;
    field.optional = description::ValueOf<T>::kOptional;
    return field;
  }

  template <class Struct>
  void element(const Struct& value) {
    reader_.begin_element();
    Struct::describe(value, *this);
    reader_.end_element();
  }

  void hand_over(Field& field, bool there) {
    field.present = present_ && there;
    reader_.field(field);
  }

  Reader& reader_;
  bool present_ = true;  // the sections around are there
};

/// Shows every field of an output to a reader.
template <class Output, class Reader>
void read_fields(const Output& output, Reader& reader) {
  FieldVisitor<Reader> visitor(reader);
  Output::describe(output, visitor);
}

/// Shows a reader what fields an output has, by the defaults of its type.
template <class Output, class Reader>
void read_fields_of(Reader& reader) {
  const Output defaults{};
  read_fields(defaults, reader);
}

}  // namespace cgsr
