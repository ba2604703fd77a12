// Shewchuk 1997: TWO-SUM, TWO-PRODUCT (by fma), FAST-EXPANSION-SUM with zero elimination,
// SCALE-EXPANSION with zero elimination.
#include "numeric/expansion.h"

#include <cmath>

namespace nonobtuse::numeric {

namespace {

// a + b = sum + error, exactly.
void two_sum(double a, double b, double& sum, double& error) {
  sum = a + b;
  const double b_virtual = sum - a;
  error = (a - (sum - b_virtual)) + (b - b_virtual);
}

// a * b = product + error, exactly. std::fma is exact whether or not the machine has it.
void two_product(double a, double b, double& product, double& error) {
  product = a * b;
  error = std::fma(a, b, -product);
}

// Appends unless zero.
void push(ExpansionTerms& terms, double value) {
  if (value != 0) terms.push_back(value);
}

ExpansionTerms sum_of(const ExpansionTerms& e, const ExpansionTerms& f) {
  if (e.empty()) return f;
  if (f.empty()) return e;
  ExpansionTerms h;
  std::size_t i = 0;
  std::size_t j = 0;
  const auto next = [&] {
    if (j == f.size() || (i < e.size() && std::abs(e[i]) < std::abs(f[j]))) return e[i++];
    return f[j++];
  };
  double q = next();
  while (i < e.size() || j < f.size()) {
    double error = 0;
    two_sum(q, next(), q, error);
    push(h, error);
  }
  push(h, q);
  return h;
}

ExpansionTerms scaled(const ExpansionTerms& e, double b) {
  ExpansionTerms h;
  if (e.empty() || b == 0) return h;
  double q = 0;
  double error = 0;
  two_product(e[0], b, q, error);
  push(h, error);
  for (std::size_t i = 1; i < e.size(); ++i) {
    double high = 0;
    double low = 0;
    two_product(e[i], b, high, low);
    double sum = 0;
    two_sum(q, low, sum, error);
    push(h, error);
    two_sum(high, sum, q, error);
    push(h, error);
  }
  push(h, q);
  return h;
}

}  // namespace

Expansion::Expansion(double value) { push(terms_, value); }

Expansion Expansion::difference(double a, double b) {
  Expansion result;
  double sum = 0;
  double error = 0;
  two_sum(a, -b, sum, error);
  push(result.terms_, error);
  push(result.terms_, sum);
  return result;
}

Expansion Expansion::product(double a, double b) {
  Expansion result;
  double high = 0;
  double low = 0;
  two_product(a, b, high, low);
  push(result.terms_, low);
  push(result.terms_, high);
  return result;
}

int Expansion::sign() const {
  if (terms_.empty()) return 0;
  return terms_.back() > 0 ? 1 : -1;
}

double Expansion::estimate() const {
  double sum = 0;
  for (const double term : terms_) sum += term;
  return sum;
}

Expansion operator+(const Expansion& a, const Expansion& b) {
  Expansion result;
  result.terms_ = sum_of(a.terms_, b.terms_);
  return result;
}

Expansion operator-(const Expansion& a) {
  Expansion result = a;
  for (double& term : result.terms_) term = -term;
  return result;
}

Expansion operator-(const Expansion& a, const Expansion& b) { return a + (-b); }

Expansion operator*(const Expansion& a, double b) {
  Expansion result;
  result.terms_ = scaled(a.terms_, b);
  return result;
}

Expansion operator*(const Expansion& a, const Expansion& b) {
  const bool a_shorter = a.size() < b.size();
  const ExpansionTerms& shorter = a_shorter ? a.terms_ : b.terms_;
  const ExpansionTerms& longer = a_shorter ? b.terms_ : a.terms_;
  Expansion result;
  for (const double term : shorter) result.terms_ = sum_of(result.terms_, scaled(longer, term));
  return result;
}

}  // namespace nonobtuse::numeric
