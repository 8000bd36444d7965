// Private to structure: blocks of columns that the host keeps.
#pragma once
#include "structure/tall_operations.hpp"

namespace plm {

class HostBlock final : public TallBlock {
  public:
    HostBlock(std::shared_ptr<TallOperations> host, std::int64_t rows)
        : host_(std::move(host)), handle_(host_->new_handle()), rows_(rows) {}
    ~HostBlock() override { host_->drop(handle_); }
    HostBlock(const HostBlock &) = delete;

    std::int64_t handle() const { return handle_; }
    std::int64_t rows() const override { return rows_; }
    std::int64_t cols() const override { return cols_; }
    /// So many columns were written by somebody else.
    void set_cols(std::int64_t cols) { cols_ = cols; }
    /// PLM_ERR_STATE where it is none.
    static const HostBlock &of(const TallBlock &block);
    std::unique_ptr<HostBlock> fresh() const { return std::make_unique<HostBlock>(host_, rows_); }
    void zero_rows(const vector<std::int64_t> &rows);

    std::unique_ptr<TallBlock> filled(std::int64_t cols, const ColumnFill &entries) const override;
    std::unique_ptr<TallBlock> patternless() const override { return filled(1, {1, 0, 0.5, 1}); }
    std::unique_ptr<TallBlock> from_column(const vector<double> &column) const override;
    std::unique_ptr<TallBlock> columns(std::int64_t first, std::int64_t count) const override;
    std::unique_ptr<TallBlock> columns(const vector<std::int64_t> &chosen) const override;
    std::unique_ptr<TallBlock> times(const Matrix &y) const override;
    std::unique_ptr<TallBlock> times(const vector<double> &y) const override;
    std::unique_ptr<TallBlock> from_rows(const SparseMatrix &b, const Matrix &f) const override;
    std::unique_ptr<TallBlock> from_rows(const SparseMatrix &b) const override;

    void reserve(std::int64_t) override {}
    void append(const TallBlock &other) override;
    void put(std::int64_t first, const TallBlock &other) override;
    void copy_column(std::int64_t from, std::int64_t to) override;
    void cut(std::int64_t cols) override { cols_ = cols; }
    void clear() override;

    void add_product(double factor, const TallBlock &v, const Matrix &y) override;
    void add_product(double factor, const TallBlock &v, std::int64_t first, const Matrix &y) override;
    void add_product(double factor, const TallBlock &v, const vector<double> &y,
                     std::int64_t column) override;
    void replace_by_product(const Matrix &y, std::int64_t count) override;
    void divide(char triangle, bool transposed, const Matrix &r) override;
    void scale(const vector<double> &factor) override;
    void divide(const vector<double> &divisor) override;
    void add(double factor, const TallBlock &v) override;
    void set_sum(const vector<double> &factor, const vector<const TallBlock *> &v) override;
    void add_sums(const std::vector<DofTerms> &sums) override;

    double at(std::int64_t row, std::int64_t column) const override;
    Matrix rows_at(const vector<std::int64_t> &rows) const override;
    vector<double> column(std::int64_t j) const override;
    Matrix gram(const TallBlock &b, bool by_columns) const override;
    vector<double> products(const TallBlock &b) const override;
    vector<double> absolute_products(const TallBlock &one) const override;
    vector<double> norms() const override;
    Matrix by_rows(const SparseMatrix &b) const override;
    void by_rows(const SparseMatrix &b, double *u) const override;
    Matrix terms_by_rows(const SparseMatrix &b) const override;
    LargestEntry largest() const override;
    bool is_finite() const override;
    double remainder(const TallBlock &q) const override;

  private:
    void copy(const HostBlock &from, std::int64_t first, const vector<std::int64_t> &chosen);
    void combine(double beta, double alpha, const HostBlock &v, const double *y, bool diagonal);
    void set_rows(double beta, const vector<std::int64_t> &rows, const Matrix &values);
    vector<double> look() const;

    std::shared_ptr<TallOperations> host_;
    std::int64_t handle_, rows_, cols_ = 0;
};

} // namespace plm
