// The extension module nonobtuse._core: the C++ interface on arrays, without defaults or checks of
// arguments, which are the Python side's.
#include "bindings.h"
#include "nonobtuse/error.h"
#include "nonobtuse/version.h"

namespace nonobtuse::python {
namespace {

// Raises an exception class of nonobtuse._errors with the arguments given.
template <class... Arguments>
void raise(const char* name, Arguments&&... arguments) {
  const nb::object type = nb::module_::import_("nonobtuse._errors").attr(name);
  const nb::object error = type(std::forward<Arguments>(arguments)...);
  PyErr_SetObject(type.ptr(), error.ptr());
}

void translate(const std::exception_ptr& failure, void*) {
  try {
    std::rethrow_exception(failure);
  } catch (const TooFewVertices& e) {
    raise("TooFewVertices", e.what(), e.least());
  } catch (const InvalidInput& e) {
    raise("InvalidInput", e.what(), e.element());
  } catch (const IoError& e) {
    PyErr_SetString(PyExc_OSError, e.what());
  }
}

}  // namespace
}  // namespace nonobtuse::python

NB_MODULE(_core, m) {
  using namespace nonobtuse::python;
  nb::register_exception_translator(translate);
  m.attr("version") = NONOBTUSE_VERSION;
  bind_attributes(m);
  bind_files(m);
  bind_quality(m);
  bind_remesh(m);
  bind_stages(m);
}
