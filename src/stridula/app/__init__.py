"""The page on which one plays the contact: a server, a session for each page, the files of the page itself."""
