"""The ready-made world `conifer_stand`."""
