#pragma once
// The list of a finding's fields, each with its key in report.json: the one list by which they are written and read.
//
// visit_fields(visit, finding) calls the visitor once for each field, in the order of the file:
//   visit("key", field)                               a number, text, list, map or struct
//   visit.text("key", field)                          a text, null where it is empty
//   visit.table("key", [&](auto& inner) {...})        fields under a key of their own
//   visit.pair("key", low, high)                      two fields as a list
//   visit.range("key", low, high)                     two numbers as a list, null where they are equal
//   visit.each("key", list, [&](auto& inner, auto& item) {...})   a list whose items are visited so
//   visit.columns(list, column...)                    a list of structs as lists of equal length, each with its key
//   visit.keyed("key", list, &T::name, &T::value)     a list of structs of two fields as a table
//   visit.gathered("key", list, "name", &T::name, &T::field)   an optional field of listed structs, each with its name
//   visit.shown("key", [&] { return ...; })           what follows from other fields: written for readers, never read
#include <type_traits>

namespace uq {

template <class T, class S>
concept SameAs = std::is_same_v<std::remove_const_t<T>, S>;

/// One field of each struct of a list, and its key.
template <class Struct, class Field>
struct FieldColumn {
  const char* key;
  Field Struct::*field;
};
template <class Struct, class Field>
FieldColumn(const char*, Field Struct::*) -> FieldColumn<Struct, Field>;

}  // namespace uq
