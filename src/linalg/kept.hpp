// A value that follows from an object, computed when first asked for and kept with it; a copy of the object,
// which may be changed, forgets it. One thread at a time, as everything that belongs to a context.
#pragma once
#include <memory>

namespace plm {

template <class T> class Kept {
  public:
    Kept() = default;
    Kept(const Kept &) {}
    Kept &operator=(const Kept &) {
        value_.reset();
        return *this;
    }
    template <class Make> std::shared_ptr<const T> get(Make make) const {
        if (!value_) value_ = std::make_shared<const T>(make());
        return value_;
    }

    /// What there is of it; null: nobody has asked for it.
    const T *known() const { return value_.get(); }

  private:
    mutable std::shared_ptr<const T> value_;
};

} // namespace plm
