# SPDX-License-Identifier: MIT
# Reads Open Sound Control 1.0 as `wholehand live --stream` sends it (docs/stream.md): messages of int32, float32 and strings,
# alone or in bundles. Time tags are not looked at, since the stream's say "at once".
extends Reference

const DEEPEST = 4  # bundles in bundles
const HEAD = 16    # bytes: "#bundle" and the time tag


# The messages of a packet in their order, each [address, arguments]. A packet that is damaged, or has another type, has none.
static func read(packet: PoolByteArray) -> Array:
	var messages = []
	if not _read_element(packet, messages, DEEPEST):
		messages.clear()
	return messages


static func _read_element(packet: PoolByteArray, messages: Array, depth: int) -> bool:
	if packet.size() % 4 != 0 or packet.size() == 0:
		return false
	if packet[0] == ord("#"):
		return depth > 0 and _read_bundle(packet, messages, depth)
	return _read_message(packet, messages)


static func _read_bundle(packet: PoolByteArray, messages: Array, depth: int) -> bool:
	if packet.size() < HEAD or _text_at(packet, 0) != "#bundle":
		return false
	var numbers = _numbers_of(packet)
	var at = HEAD
	while at < packet.size():
		numbers.seek(at)
		var size = numbers.get_32()
		at += 4
		if size <= 0 or size > packet.size() - at:
			return false
		if not _read_element(packet.subarray(at, at + size - 1), messages, depth - 1):
			return false
		at += size
	return true


static func _read_message(packet: PoolByteArray, messages: Array) -> bool:
	var address_end = _text_end(packet, 0)
	var tags_end = _text_end(packet, address_end)
	if address_end < 0 or tags_end < 0:
		return false
	var tags = _text_at(packet, address_end)
	if packet[0] != ord("/") or not tags.begins_with(","):
		return false
	var arguments = []
	var numbers = _numbers_of(packet)
	var at = tags_end
	for k in range(1, tags.length()):
		var next = _text_end(packet, at) if tags[k] == "s" else at + 4
		if next < 0 or next > packet.size():
			return false
		numbers.seek(at)
		match tags[k]:
			"i":
				arguments.append(numbers.get_32())
			"f":
				arguments.append(numbers.get_float())
			"s":
				arguments.append(_text_at(packet, at))
			_:
				return false
		at = next
	messages.append([_text_at(packet, 0), arguments])
	return at == packet.size()


static func _numbers_of(packet: PoolByteArray) -> StreamPeerBuffer:
	var numbers = StreamPeerBuffer.new()
	numbers.big_endian = true
	numbers.data_array = packet
	return numbers


# A string ends with one to four zero bytes, at a multiple of four. -1: it does not end.
static func _text_end(packet: PoolByteArray, at: int) -> int:
	if at < 0:
		return -1
	while at + 4 <= packet.size():
		at += 4
		if packet[at - 1] == 0:
			return at
	return -1


static func _text_at(packet: PoolByteArray, at: int) -> String:
	var end = _text_end(packet, at)
	return packet.subarray(at, end - 1).get_string_from_utf8() if end > at else ""
