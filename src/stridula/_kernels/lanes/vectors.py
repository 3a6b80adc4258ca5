"""Vectors of eight doubles as a type of compiled code, with the functions of `operations` on a processor.

Each function becomes instructions of its caller, under the arithmetic options of the caller.
"""

import operator
from typing import Any

from llvmlite import ir
from numba.core import cgutils, types
from numba.core.datamodel.models import PrimitiveModel
from numba.extending import lower_builtin, register_model, type_callable

from . import operations as lanes
from .compiled import overloaded

LANES = lanes.WIDTH

_DOUBLES = ir.VectorType(ir.DoubleType(), LANES)
_BITS = ir.VectorType(ir.IntType(1), LANES)
_INDEX = ir.IntType(32)


class Vector(types.Type):
    """Numba's type of `LANES` doubles."""


class Mask(types.Type):
    """Numba's type of `LANES` truth values."""


VECTOR, MASK = Vector("vector of doubles"), Mask("vector of truth values")


@register_model(Vector)
class _VectorModel(PrimitiveModel):
    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, _DOUBLES)


@register_model(Mask)
class _MaskModel(PrimitiveModel):
    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, _BITS)


def _type(function: Any, typer: Any) -> None:
    """Declare the return type of a function for types of arguments, None where it does not accept them."""
    type_callable(function)(lambda context: typer)


def _lower(function: Any, *kinds: Any) -> Any:
    """Declare the code of a function for types of arguments."""
    return lower_builtin(function, *kinds)


def _indices(numbers: Any) -> Any:
    return ir.Constant(ir.VectorType(_INDEX, len(numbers)), list(numbers))


def _vectors(context: Any, builder: Any, signature: Any, args: Any) -> Any:
    """Return arguments as vectors, a number in every lane."""
    found = []
    for value, kind in zip(args, signature.args, strict=True):
        if kind is VECTOR:
            found.append(value)
        else:
            number = context.cast(builder, value, kind, types.float64)
            first = builder.insert_element(ir.Constant(_DOUBLES, ir.Undefined), number, _INDEX(0))
            found.append(builder.shuffle_vector(first, first, _indices([0] * LANES)))
    return found


def _address(context: Any, builder: Any, signature: Any, args: Any, rows_are_vectors: Any = False) -> Any:
    """Return the address of a vector in an array with a contiguous last axis, from the indices of its axes."""
    kind = signature.args[0]
    array = context.make_array(kind)(context, builder, args[0])
    strides = [*cgutils.unpack_tuple(builder, array.strides)[:-1], ir.IntType(64)(8)]
    if kind.ndim == 3:
        # Rows of a block are vectors: a constant stride saves a register for each.
        strides[1:] = [ir.IntType(64)(8 * LANES)]
    if rows_are_vectors:
        strides = [ir.IntType(64)(8 * LANES)]
    offset = ir.IntType(64)(0)
    for stride, index, kind in zip(strides, args[1:], signature.args[1:], strict=False):
        offset = builder.add(offset, builder.mul(stride, context.cast(builder, index, kind, types.int64)))
    return cgutils.pointer_add(builder, array.data, offset, _DOUBLES.as_pointer())


_type(lanes.load, lambda rows, k, row, runs: VECTOR)
_type(lanes.store, lambda rows, k, row, runs, value: types.void if value is VECTOR else None)
_type(lanes.read, lambda array, row, column, like: VECTOR if like is VECTOR else None)
_type(lanes.write, lambda array, row, column, value: types.void if value is VECTOR else None)


@_lower(lanes.load, types.Array, types.Integer, types.Integer, types.BaseTuple)
@_lower(lanes.read, types.Array, types.Integer, types.Integer, Vector)
def _load(context: Any, builder: Any, signature: Any, args: Any) -> Any:
    return builder.load(_address(context, builder, signature, args), align=8)


@_lower(lanes.store, types.Array, types.Integer, types.Integer, types.BaseTuple, Vector)
@_lower(lanes.write, types.Array, types.Integer, types.Integer, Vector)
def _store(context: Any, builder: Any, signature: Any, args: Any) -> Any:
    builder.store(args[-1], _address(context, builder, signature, args), align=8)
    return context.get_dummy_value()


_type(lanes.held, lambda array, row, runs: None if lanes.of_one(runs) else VECTOR)
_type(lanes.hold, lambda array, row, runs, value: types.void if value is VECTOR else None)


@_lower(lanes.held, types.Array, types.Integer, types.BaseTuple)
def _held(context: Any, builder: Any, signature: Any, args: Any) -> Any:
    return builder.load(_address(context, builder, signature, args, True), align=8)


@_lower(lanes.hold, types.Array, types.Integer, types.BaseTuple, Vector)
def _hold(context: Any, builder: Any, signature: Any, args: Any) -> Any:
    builder.store(args[-1], _address(context, builder, signature, args, True), align=8)
    return context.get_dummy_value()


_type(lanes.spread, lambda value: VECTOR)


@_lower(lanes.spread, types.Number)
def _spread(context: Any, builder: Any, signature: Any, args: Any) -> Any:
    return _vectors(context, builder, signature, args)[0]


_type(lanes.choose, lambda condition, yes, no: VECTOR if condition is MASK else None)


@_lower(lanes.choose, Mask, types.Any, types.Any)
def _choose(context: Any, builder: Any, signature: Any, args: Any) -> Any:
    yes, no = _vectors(context, builder, signature.replace(args=signature.args[1:]), args[1:])
    return builder.select(args[0], yes, no)


def _call(name: Any, count: Any) -> Any:
    """Return code that calls a processor instruction on vectors."""

    def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        kind = ir.FunctionType(_DOUBLES, [_DOUBLES] * count)
        function = cgutils.get_or_insert_function(builder.module, kind, f"{name}.v{LANES}f64")
        return builder.call(function, _vectors(context, builder, signature, args))

    return code


_type(lanes.whole, lambda value: VECTOR if value is VECTOR else None)
_type(lanes.magnitude, lambda value: VECTOR if value is VECTOR else None)


def _fused(a: Any, b: Any, c: Any) -> Any:
    """Return the type of a product and a sum: of vectors, or of numbers."""
    if VECTOR in (a, b, c):
        return VECTOR
    return types.float64 if all(isinstance(kind, types.Float) for kind in (a, b, c)) else None


_type(lanes.fused, _fused)
_lower(lanes.whole, Vector)(_call("llvm.floor", 1))
_lower(lanes.magnitude, Vector)(_call("llvm.fabs", 1))
_lower(lanes.fused, types.Any, types.Any, types.Any)(_call("llvm.fmuladd", 3))


@_lower(lanes.fused, types.Float, types.Float, types.Float)
def _fused_numbers(context: Any, builder: Any, signature: Any, args: Any) -> Any:
    kind = ir.FunctionType(ir.DoubleType(), [ir.DoubleType()] * 3)
    return builder.call(cgutils.get_or_insert_function(builder.module, kind, "llvm.fmuladd.f64"), args)


def _over_lanes(predicate: Any, bits: Any) -> Any:
    """Return code that compares the truth values in all lanes with a pattern."""

    def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        found = builder.bitcast(args[0], ir.IntType(LANES))
        return builder.icmp_unsigned(predicate, found, found.type(bits))

    return code


_type(lanes.anywhere, lambda condition: types.boolean if condition is MASK else None)
_type(lanes.everywhere, lambda condition: types.boolean if condition is MASK else None)
_lower(lanes.anywhere, Mask)(_over_lanes("!=", 0))
_lower(lanes.everywhere, Mask)(_over_lanes("==", 2**LANES - 1))

_type(lanes.total, lambda value, like: VECTOR if like is VECTOR else types.float64)


@_lower(lanes.total, Vector, Vector)
def _same(context: Any, builder: Any, signature: Any, args: Any) -> Any:
    return args[0]


@_lower(lanes.total, Vector, types.Float)
def _sum(context: Any, builder: Any, signature: Any, args: Any) -> Any:
    vector, count = args[0], LANES
    while count > 1:
        half = count // 2
        low = builder.shuffle_vector(vector, vector, _indices(range(half)))
        high = builder.shuffle_vector(vector, vector, _indices(range(half, count)))
        vector, count = builder.fadd(low, high), half
    return builder.extract_element(vector, _INDEX(0))


@overloaded(lanes.lanes_of)
def _lanes_of(like: Any) -> Any:
    return (lambda like: LANES) if like is VECTOR else None


_type(lanes.lane, lambda value, i: types.float64 if value is VECTOR else None)
_type(lanes.with_lane, lambda value, i, number: VECTOR if value is VECTOR else None)


@_lower(lanes.lane, Vector, types.Integer)
def _lane(context: Any, builder: Any, signature: Any, args: Any) -> Any:
    return builder.extract_element(*args)


@_lower(lanes.with_lane, Vector, types.Integer, types.Float)
def _with_lane(context: Any, builder: Any, signature: Any, args: Any) -> Any:
    return builder.insert_element(args[0], args[2], args[1])


def _pair(kind: Any) -> Any:
    """Return the typing function of an operation on two vectors, or a vector and a number."""
    return lambda a, b: (
        kind if VECTOR in (a, b) and all(isinstance(k, (Vector, types.Number)) for k in (a, b)) else None
    )


def _operation(instruction: Any, *words: Any) -> Any:
    return lambda context, builder, signature, args: instruction(
        builder, *words, *_vectors(context, builder, signature, args)
    )


_PAIRS = (Vector, Vector), (Vector, types.Number), (types.Number, Vector)
_ARITHMETIC = {"add": "fadd", "sub": "fsub", "mul": "fmul", "truediv": "fdiv"}
for _name, _instruction in _ARITHMETIC.items():
    for _operator in (getattr(operator, _name), getattr(operator, f"i{_name}")):
        _type(_operator, _pair(VECTOR))
        for _kinds in _PAIRS:
            _lower(_operator, *_kinds)(_operation(getattr(ir.IRBuilder, _instruction)))
for _operator, _sign in ((operator.lt, "<"), (operator.le, "<="), (operator.gt, ">"), (operator.ge, ">=")):
    _type(_operator, _pair(MASK))
    for _kinds in _PAIRS:
        _lower(_operator, *_kinds)(_operation(ir.IRBuilder.fcmp_ordered, _sign))
_type(operator.neg, lambda value: VECTOR if value is VECTOR else None)
_lower(operator.neg, Vector)(_operation(ir.IRBuilder.fneg))
