"""The binary form of OUTPUT4: Fortran records of words of 4 bytes, or of 8 where Nastran ran with such."""
import struct

import numpy

from ..errors import FileError
from ..tables import content
from .output4_block import Block, dense_of, strings_of


def byte_order(head):
    """(order, bytes of a word) by the length of the first record, which is four integers and a name; None: no such file."""
    if len(head) < 8:
        return None
    for order in "<>":
        length, = struct.unpack(order + "i", head[:4])
        if length in (24, 48) and head[4 + length:8 + length] in (head[:4], b""):
            return order, length // 6
    return None


class Records:
    """The records of the bytes of a file, each checked to be there and to end as it began."""

    def __init__(self, path, order, word):
        self.path, self.order, self.word, self.data, self.at = path, order, word, content(path), 0

    def fail(self, text):
        raise FileError(self.path, 0, f"at byte {self.at}: {text}")

    def next(self):
        """The bytes of the next record; None at the end."""
        data, at = self.data, self.at
        if at == len(data):
            return None
        if at + 8 > len(data):
            self.fail("the file ends within a record")
        length, = struct.unpack(self.order + "i", data[at:at + 4])
        if length < 0 or at + 8 + length > len(data):
            self.fail(f"a record of {length} bytes, of which {len(data) - at - 8} are there")
        if data[at + 4 + length:at + 8 + length] != data[at:at + 4]:
            self.fail(f"a record of {length} bytes does not end as it began")
        self.at = at + 8 + length
        return data[at + 4:at + 4 + length]

    def integers(self, data):
        return numpy.frombuffer(data, f"{self.order}i{self.word}")


def blocks(path, order):
    """The matrices of a file, as Block."""
    records, result = Records(path, *order), []
    while True:
        begin, head = records.at, records.next()
        if head is None:
            return result
        if len(head) != 6 * records.word:
            records.at = begin
            records.fail(f"a record of {len(head)} bytes where the header of a matrix is expected")
        columns, rows, form, kind = records.integers(head[:4 * records.word]).tolist()
        name = head[4 * records.word:].decode("latin-1").replace("\0", " ")
        if records.word == 8:  # letters stand in the first halves of words of 8 bytes, or in 8 of 16
            name = name[:4] + name[8:12] if not name[4:8].strip() else name[:8]
        block = Block(path, 0, columns, rows, form, kind, name)
        read_columns(block, records)
        result.append(block)


def read_columns(block, records):
    """The columns of a matrix, until the one behind the last."""
    real = f"{records.order}f{8 if records.word == 8 or block.kind in (2, 4) else 4}"
    words_of_real = numpy.dtype(real).itemsize // records.word
    parts = []
    while True:
        begin, data = records.at, records.next()
        if data is None:
            records.fail(f"the file ends before matrix {block.name} does")
        words = records.integers(data[:len(data) // records.word * records.word])
        if len(words) < 3:
            records.at = begin
            records.fail(f"a record of {len(data)} bytes where a column is expected")
        column, row, n_words = words[:3].tolist()
        if column > block.n_columns:
            break
        if not 0 <= n_words == len(words) - 3:
            records.at = begin
            records.fail(f"a column of {n_words} words in a record of {len(words)}")
        body = data[3 * records.word:3 * records.word + n_words * records.word]
        try:
            if row > 0:
                values = numpy.frombuffer(body[:len(body) // numpy.dtype(real).itemsize * numpy.dtype(real).itemsize], real)
                block.add(column, row, len(values) // block.per_number, 0)
                parts.append(values[:len(values) // block.per_number * block.per_number])
            else:
                sparse_column(block, records, column, body, words[3:].tolist(), real, words_of_real, parts)
        except FileError as error:
            raise FileError(error.file, 0, f"at byte {begin}: {error.text}") from None
    block.values = numpy.concatenate(parts).astype(float) if parts else numpy.empty(0)


def sparse_column(block, records, column, body, words, real, words_of_real, parts):
    """Strings of a column; see output4.sparse_column."""
    at = 0
    while at < len(words):
        if block.bigmat:
            if at + 2 > len(words):
                raise FileError(block.path, 0, f"column {column} ends within the header of a string")
            length, row = words[at] - 1, words[at + 1]
            at += 2
        else:
            length, row = words[at] // 65536 - 1, words[at] % 65536
            at += 1
        if length < words_of_real or length % (words_of_real * block.per_number) or at + length > len(words):
            raise FileError(block.path, 0, f"a string of {length} words where {len(words) - at} are left in column {column}")
        values = numpy.frombuffer(body[at * records.word:(at + length) * records.word], real)
        block.add(column, row, len(values) // block.per_number, 0)
        parts.append(values)
        at += length


def write_block(file, name, matrix, kind, layout, order):
    """One matrix, in words of 4 bytes."""
    real = f"{order}f{8 if kind == 2 else 4}"

    def record(*pieces):
        data = b"".join(pieces)
        length = struct.pack(order + "i", len(data))
        file.write(length + data + length)

    def integers(*numbers):
        return struct.pack(f"{order}{len(numbers)}i", *numbers)
    n = matrix.shape[0]
    record(integers(n, -n if layout == "bigmat" else n, 6, kind), name.ljust(8).encode("ascii"))
    for j in range(n):
        if matrix.indptr[j] == matrix.indptr[j + 1]:
            continue
        if layout == "dense":
            row, values = dense_of(matrix, j)
            record(integers(j + 1, row + 1, kind * len(values)), values.astype(real).tobytes())
            continue
        pieces = []
        for row, values in strings_of(matrix, j):
            length = kind * len(values) + 1
            head = (length, row + 1) if layout == "bigmat" else (65536 * length + row + 1,)
            pieces += [integers(*head), values.astype(real).tobytes()]
        record(integers(j + 1, 0, sum(map(len, pieces)) // 4), *pieces)
    record(integers(n + 1, 1, kind), numpy.ones(1, real).tobytes())
