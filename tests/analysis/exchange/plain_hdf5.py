"""Whether a session file needs nothing of HDF5 that MATLAB's h5read lacks: one-dimensional compound
datasets of integers, reals and texts of fixed length, and the filters shuffle and deflate alone.

    plain_hdf5.py SESSION.h5
"""
import sys

import h5py
from h5py import h5d, h5t, h5z

PLAIN = {h5t.INTEGER, h5t.FLOAT, h5t.STRING}
FILTERS = {h5z.FILTER_SHUFFLE, h5z.FILTER_DEFLATE}

with h5py.File(sys.argv[1], "r") as file:
    assert {"samples", "trials", "events", "stimuli", "timing"} <= set(file)
    for name, dataset in file.items():
        assert isinstance(dataset, h5py.Dataset), name
        assert dataset.ndim == 1, name
        properties = dataset.id.get_create_plist()
        assert properties.get_layout() == h5d.CHUNKED and properties.get_external_count() == 0
        filters = {properties.get_filter(i)[0] for i in range(properties.get_nfilters())}
        assert filters <= FILTERS, (name, filters)
        kind = dataset.id.get_type()
        assert kind.get_class() == h5t.COMPOUND, name
        for i in range(kind.get_nmembers()):
            member = kind.get_member_type(i)
            assert member.get_class() in PLAIN, (name, kind.get_member_name(i))
            if member.get_class() == h5t.STRING:
                assert not member.is_variable_str(), (name, kind.get_member_name(i))
            else:
                assert member.get_order() == h5t.ORDER_LE
                assert member.get_size() in (1, 2, 4, 8)
print("plain")
